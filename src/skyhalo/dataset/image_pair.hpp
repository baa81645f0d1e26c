#pragma once

#include <filesystem>

#include "skyhalo/dataset/frame_source.hpp"

namespace skyhalo {

/// One pair of image files as a recording of one frame, taken by a body at rest in the
/// origin.
class ImagePairSource final : public FrameSource {
 public:
  /// Reads both images. An empty `pair.image_size_px` is taken from them; the time stamp is the
  /// epoch. Throws `Error` (input) naming the file when one cannot be read or has another size than
  /// the pair's camera gives.
  ImagePairSource(const std::filesystem::path& left,
                  const std::filesystem::path& right,
                  StereoPair pair);

  [[nodiscard]] std::string name() const override { return rig_.pairs.front().name; }

  [[nodiscard]] const StereoRig& rig() const override { return rig_; }

  [[nodiscard]] int frame_count() const override { return 1; }

  [[nodiscard]] Timestamp stamp(int) const override { return {}; }

  [[nodiscard]] Pose T_map_body(int) const override { return Pose::Identity(); }

  [[nodiscard]] FrameSet read(int) const override;

 private:
  StereoRig rig_;
  StereoImages images_;
};

}  // namespace skyhalo
