#pragma once

#include <string>

#include "skyhalo/base/timestamp.hpp"
#include "skyhalo/camera/stereo_rig.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// A recording of stereo frames with poses, whatever its format. Frames are numbered from 0.
/// Reading is `const` and may be done by several threads at once.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  FrameSource(FrameSource&&) = delete;
  FrameSource& operator=(FrameSource&&) = delete;
  virtual ~FrameSource() = default;

  /// A short name for reports, for instance the folder's.
  [[nodiscard]] virtual std::string name() const = 0;

  [[nodiscard]] virtual const StereoRig& rig() const = 0;

  [[nodiscard]] virtual int frame_count() const = 0;

  /// When a frame was taken.
  [[nodiscard]] virtual Timestamp stamp(int frame) const = 0;

  /// Where the body was. The map frame is the recording's; each source says which.
  [[nodiscard]] virtual Pose T_map_body(int frame) const = 0;

  /// The images of a frame. Throws `Error` (input) naming the file when one cannot be read.
  [[nodiscard]] virtual FrameSet read(int frame) const = 0;
};

}  // namespace skyhalo
