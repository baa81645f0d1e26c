#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/calibration/rig_description.hpp"

namespace skyhalo {
namespace {

/// The pair without its images' side.
StereoPair named_pair(const PairDescription& description) {
  return {.name = description.name,
          .image_size_px = {},
          .model = {},
          .T_body_camera = description.T_body_camera,
          .masks_px = description.masks_px,
          .raw = std::nullopt,
          .downscale = description.downscale,
          .rcrop_px = description.rcrop_px,
          .min_range_m = description.min_range_m,
          .max_range_m = description.max_range_m,
          .line_time_s = description.line_time_s};
}

StereoPair resolve_pair(const PairDescription& description) {
  StereoPair pair = named_pair(description);
  if (const auto* rectified = std::get_if<RectifiedPairDescription>(&description.images)) {
    pair.image_size_px = rectified->size_px;
    pair.model = rectified->model;
    return pair;
  }
  const auto& [cameras, rectify_to] = std::get<RawPairDescription>(description.images);
  const VirtualPair virtual_pair = make_virtual_pair(cameras, rectify_to);
  pair.image_size_px = virtual_pair.size_px;
  pair.model = virtual_pair.model;
  pair.T_body_camera =
      description.T_body_camera * make_pose(virtual_pair.R_right_cam, Eigen::Vector3d::Zero());
  pair.raw =
      RawImaging{cameras.left, cameras.right, virtual_pair.R_left_cam, virtual_pair.R_right_cam};
  return pair;
}

/// A key of the virtual pair stands one section deeper in the file.
std::string key_in_file(const std::string& message) {
  return message.starts_with("T_right_left") ? message : "rectify_to." + message;
}

}  // namespace

StereoRig resolve(const RigDescription& description) {
  if (description.pairs.empty()) {
    throw Error(ErrorKind::kInput, "pairs: expected at least one stereo pair");
  }
  StereoRig rig;
  for (std::size_t i = 0; i < description.pairs.size(); ++i) {
    try {
      rig.pairs.push_back(resolve_pair(description.pairs[i]));
    } catch (const Error& error) {
      throw Error(error.kind(), "pairs[" + std::to_string(i) + "]." + key_in_file(error.what()));
    }
  }
  return rig;
}

}  // namespace skyhalo
