#include "skyhalo/dataset/euroc_writer.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <utility>

#include "skyhalo/base/number_text.hpp"
#include "skyhalo/dataset/frame_checks.hpp"
#include "skyhalo/dataset/stamp_text.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/output_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = "mav0";

template <class Numbers>
std::string list_of(const Numbers& numbers) {
  std::string text;
  for (const double number : numbers) {
    text += (text.empty() ? "" : ", ") + exact_number_text(number);
  }
  return "[" + text + "]";
}

/// The lens in the words of the layout: distortion model and coefficients.
struct LensText {
  std::string model;
  std::string coefficients;
};

LensText lens_text(const Lens& lens) {
  if (const auto* fisheye = std::get_if<KannalaBrandtLens>(&lens)) {
    return {"equidistant", list_of(fisheye->distortion())};
  }
  if (const auto* radial = std::get_if<RadialTangentialLens>(&lens)) {
    const RadialTangentialLens::Distortion& k = radial->distortion();
    const bool four = std::all_of(k.begin() + 4, k.end(), [](double x) { return x == 0.0; });
    const auto count = four ? std::size_t{4} : k.size();
    return {"radial-tangential", list_of(std::span(k).first(count))};
  }
  throw Error(ErrorKind::kInput,
              "lens: EuRoC's layout is for radial-tangential and Kannala-Brandt (equidistant) "
              "lenses");
}

std::string matrix_text(const Pose& T) {
  std::vector<double> numbers;
  for (Eigen::Index row = 0; row < 4; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      numbers.push_back(T.matrix()(row, column));
    }
  }
  return "T_BS:\n  cols: 4\n  rows: 4\n  data: " + list_of(numbers) + "\n";
}

/// Frames per second; 20 where a single frame says nothing.
double rate_hz(const std::vector<StampedPose>& poses) {
  if (poses.size() < 2) {
    return 20.0;
  }
  const std::chrono::duration<double> span = poses.back().stamp - poses.front().stamp;
  return static_cast<double>(poses.size() - 1) / span.count();
}

std::string sensor_text(const RawCamera& camera, const Pose& T_body_camera, double rate) {
  const Intrinsics& f = intrinsics(camera.lens);
  const LensText lens = lens_text(camera.lens);
  return "sensor_type: camera\ncomment: skyhalo\n\n# the camera to the body, which is the IMU\n" +
         matrix_text(T_body_camera) + "\nrate_hz: " + exact_number_text(rate) + "\nresolution: [" +
         std::to_string(camera.size_px.width) + ", " + std::to_string(camera.size_px.height) +
         "]\ncamera_model: pinhole\nintrinsics: " +
         list_of(std::array{f.fx_px, f.fy_px, f.cx_px, f.cy_px}) +
         "  # fu, fv, cu, cv\ndistortion_model: " + lens.model +
         "\ndistortion_coefficients: " + lens.coefficients + "\n";
}

/// The velocity (m/s, world) at a frame: between its neighbours, as far as there are any.
Eigen::Vector3d velocity_mps(const std::vector<StampedPose>& poses, std::size_t frame) {
  const StampedPose& before = poses[frame == 0 ? 0 : frame - 1];
  const StampedPose& after = poses[std::min(frame + 1, poses.size() - 1)];
  const std::chrono::duration<double> time = after.stamp - before.stamp;
  if (!(time.count() > 0.0)) {
    return Eigen::Vector3d::Zero();
  }
  return (after.T_map_body.translation() - before.T_map_body.translation()) / time.count();
}

std::string truth_text(const std::vector<StampedPose>& poses) {
  std::string text =
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z [], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], "
      "b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], "
      "b_a_RS_S_z [m s^-2]\n";
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d p_m = poses[i].T_map_body.translation();
    const Eigen::Quaterniond q(poses[i].T_map_body.linear());
    const Eigen::Vector3d v_mps = velocity_mps(poses, i);
    text += stamp_text(poses[i].stamp);
    for (const double number :
         {p_m.x(), p_m.y(), p_m.z(), q.w(), q.x(), q.y(), q.z(), v_mps.x(), v_mps.y(), v_mps.z()}) {
      text += "," + exact_number_text(number);
    }
    text += ",0,0,0,0,0,0\n";
  }
  return text;
}

}  // namespace

std::vector<EurocWriter::Camera> EurocWriter::cameras_of(const PairDescription& pair) {
  std::vector<Camera> cameras;
  if (const auto* raw = std::get_if<RawPairDescription>(&pair.images)) {
    cameras = {{raw->cameras.left, pair.T_body_camera * raw->cameras.T_right_left},
               {raw->cameras.right, pair.T_body_camera}};
  } else {
    const auto& rectified = std::get<RectifiedPairDescription>(pair.images);
    const auto* model = std::get_if<PinholePair>(&rectified.model);
    if (model == nullptr) {
      throw Error(ErrorKind::kInput,
                  "pair '" + pair.name + "': EuRoC's layout is for raw or pinhole pairs");
    }
    Pose T_right_left = Pose::Identity();
    T_right_left.translation().x() = -model->baseline_m;
    const auto camera = [&](double principal_u_px) {
      const Intrinsics f{model->focal_px, model->focal_px, principal_u_px, model->principal_v_px};
      return RawCamera{rectified.size_px, RadialTangentialLens(f, {})};
    };
    cameras = {{camera(model->principal_u_px - model->disparity_offset_px),
                pair.T_body_camera * T_right_left},
               {camera(model->principal_u_px), pair.T_body_camera}};
  }
  for (const Camera& camera : cameras) {
    (void)lens_text(camera.camera.lens);
    if (!is_rigid(camera.T_body_camera)) {
      throw Error(ErrorKind::kInput,
                  "T_body_camera, T_right_left: expected finite rigid transforms");
    }
  }
  return cameras;
}

EurocWriter::EurocWriter(const fs::path& folder, const PairDescription& pair)
    : staged_(folder), cameras_(cameras_of(pair)) {
  expect_unused(staged_.folder());
}

void EurocWriter::add(const StampedPose& pose, const StereoImages& images) {
  const int number = static_cast<int>(poses_.size());
  if (pose.stamp.time_since_epoch().count() < 0 ||
      (!poses_.empty() && pose.stamp <= poses_.back().stamp)) {
    throw frame_error(number, "stamp: expected one after the frame before's, and after 1970");
  }
  check_rigid(pose.T_map_body, number, "T_map_body");
  check_image(images.left, {cameras_[0].camera.size_px}, number, "left image");
  check_image(images.right, {cameras_[1].camera.size_px}, number, "right image");
  const std::string name = stamp_text(pose.stamp) + ".png";
  write_png(staged_.file(kRoot / "cam0" / "data" / name), images.left);
  write_png(staged_.file(kRoot / "cam1" / "data" / name), images.right);
  poses_.push_back(pose);
}

void EurocWriter::finish() {
  if (poses_.empty()) {
    throw Error(ErrorKind::kInput, "flight: expected at least one frame");
  }
  std::string list = "#timestamp [ns],filename\n";
  for (const StampedPose& pose : poses_) {
    list += stamp_text(pose.stamp) + "," + stamp_text(pose.stamp) + ".png\n";
  }
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const fs::path folder = kRoot / ("cam" + std::to_string(i));
    write_bytes(staged_.file(folder / "data.csv"), list);
    write_bytes(staged_.file(folder / "sensor.yaml"),
                sensor_text(cameras_[i].camera, cameras_[i].T_body_camera, rate_hz(poses_)));
  }
  write_bytes(staged_.file(kRoot / "body.yaml"), "comment: skyhalo; the body is the IMU\n");
  const fs::path truth = kRoot / "state_groundtruth_estimate0";
  write_bytes(staged_.file(truth / "data.csv"), truth_text(poses_));
  write_bytes(staged_.file(truth / "sensor.yaml"),
              "sensor_type: visual-inertial\ncomment: skyhalo\n" + matrix_text(Pose::Identity()));
  staged_.commit();
}

}  // namespace skyhalo
