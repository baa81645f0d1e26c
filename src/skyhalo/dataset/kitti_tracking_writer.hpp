#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "skyhalo/camera/stereo_rig.hpp"
#include "skyhalo/dataset/scene_object.hpp"
#include "skyhalo/dataset/velodyne_file.hpp"
#include "skyhalo/io/staged_folder.hpp"

namespace skyhalo {

/// The sensors of a sequence in the layout of KITTI's tracking benchmark.
struct KittiTrackingSetup {
  StereoPair pair;                       ///< rectified, pinhole
  Pose T_body_laser = Pose::Identity();  ///< the body is the INS
};

/// What was recorded at one moment.
struct KittiTrackingFrame {
  StereoImages images;                 ///< 8-bit, grey or BGR, of the pair's size
  Pose T_map_body = Pose::Identity();  ///< map: z up
  std::optional<LaserReturns> scan;    ///< none, or no point: the frame has no scan file
  std::vector<SceneObject> objects{};  ///< those the left camera does not see are left out
};

/// Writes a sequence in the layout of KITTI's tracking benchmark: `training/image_02` (left) and
/// `image_03` (right), `velodyne`, `oxts`, `label_02` and `calib`. Frames are 0.1 s apart.
///
/// Camera 0 of the calibration is the left camera, so that `P0` is `P2`, `P1` is `P3`, and `R_rect`
/// is the identity. The first pose stands at 49 degrees north, 8.4 degrees east and 116 m; the
/// map's x points east. Poses relative to the first one read back to 1e-6 m and 1e-9 rad over
/// kilometres. Velocities, accelerations (with gravity, as an INS measures them) and rates are
/// differences of poses. A label's box stands upright in the left camera's frame, as the layout
/// wants it, and holds the object's box.
///
/// The files are written to a hidden folder beside `folder` and appear with `finish()`, the
/// calibration last; without it nothing stays. Used by one thread at a time.
class KittiTrackingWriter {
 public:
  /// `folder` is what `training/` lies in and may hold other sequences; `sequence` is in 0...9999.
  /// Throws `Error` (input) for a pair that is raw, not a pinhole or without a size, and `Error`
  /// (failure) when the folder cannot be written to or has this sequence already.
  KittiTrackingWriter(const std::filesystem::path& folder, int sequence, KittiTrackingSetup setup);

  /// Adds the next frame. Throws `Error` (input) naming the frame for images of another size or
  /// depth, a pose that is not rigid and for an object that `check` refuses; `Error` (failure) when
  /// it cannot be written.
  void add(const KittiTrackingFrame& frame);

  /// Makes the sequence appear. Throws `Error` (input) without a frame and `Error` (failure) when
  /// it cannot be written or was finished before.
  void finish();

 private:
  StagedFolder staged_;
  std::string sequence_;  // four digits
  KittiTrackingSetup setup_;
  std::vector<Pose> poses_;  // T_map_body
  std::string labels_;
};

}  // namespace skyhalo
