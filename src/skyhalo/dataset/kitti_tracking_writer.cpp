#include "skyhalo/dataset/kitti_tracking_writer.hpp"

#include <span>
#include <utility>

#include "skyhalo/base/number_text.hpp"
#include "skyhalo/dataset/frame_checks.hpp"
#include "skyhalo/dataset/kitti_label_text.hpp"
#include "skyhalo/dataset/kitti_oxts.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/output_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = "training";

std::string four_digits(int sequence) {
  if (sequence < 0 || sequence > 9999) {
    throw Error(ErrorKind::kInput,
                "sequence: expected a number in 0...9999, found " + std::to_string(sequence));
  }
  std::string digits = std::to_string(sequence);
  digits.insert(0, 4 - digits.size(), '0');
  return digits;
}

KittiTrackingSetup checked_setup(KittiTrackingSetup setup) {
  const StereoPair& pair = setup.pair;
  if (pair.raw || !std::holds_alternative<PinholePair>(pair.model) || pair.image_size_px.empty()) {
    throw Error(ErrorKind::kInput,
                "pair '" + pair.name +
                    "': KITTI's layout is for rectified pinhole pairs with an image size");
  }
  if (!is_rigid(pair.T_body_camera) || !is_rigid(setup.T_body_laser)) {
    throw Error(ErrorKind::kInput, "T_body_camera, T_body_laser: expected finite rigid transforms");
  }
  return setup;
}

/// The left camera stands a baseline to the left of the right one.
Pose T_body_left(const StereoPair& pair) {
  Pose T_right_left = Pose::Identity();
  T_right_left.translation().x() = -baseline_m(pair.model);
  return pair.T_body_camera * T_right_left;
}

LabelCamera left_camera_of(const StereoPair& pair) {
  const PinholePair& model = std::get<PinholePair>(pair.model);
  return {model.focal_px,
          model.principal_u_px - model.disparity_offset_px,
          model.principal_v_px,
          pair.image_size_px};
}

/// A line of a calibration file.
template <class Matrix>
std::string matrix_line(const std::string& key, const Matrix& matrix) {
  std::string line = key;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      line += " " + number_text("%.12e", matrix(row, column));
    }
  }
  return line + "\n";
}

using Matrix34 = Eigen::Matrix<double, 3, 4>;

/// `K [I | t]` of a camera that stands so far to the right of camera 0.
Matrix34 projection(const PinholePair& pair, double principal_u_px, double right_m) {
  Matrix34 P = Matrix34::Zero();
  P(0, 0) = pair.focal_px;
  P(1, 1) = pair.focal_px;
  P(2, 2) = 1.0;
  P(0, 2) = principal_u_px;
  P(1, 2) = pair.principal_v_px;
  P(0, 3) = -pair.focal_px * right_m;
  return P;
}

std::string calibration_text(const KittiTrackingSetup& setup) {
  const PinholePair& pair = std::get<PinholePair>(setup.pair.model);
  const Matrix34 left = projection(pair, pair.principal_u_px - pair.disparity_offset_px, 0.0);
  const Matrix34 right = projection(pair, pair.principal_u_px, pair.baseline_m);
  const Pose T_laser_body = setup.T_body_laser.inverse();
  const Pose T_left_laser = T_body_left(setup.pair).inverse() * setup.T_body_laser;
  const Matrix34 velo_cam = T_left_laser.matrix().topRows<3>();
  const Matrix34 imu_velo = T_laser_body.matrix().topRows<3>();
  return matrix_line("P0:", left) + matrix_line("P1:", right) + matrix_line("P2:", left) +
         matrix_line("P3:", right) + matrix_line("R_rect", Eigen::Matrix3d::Identity().eval()) +
         matrix_line("Tr_velo_cam", velo_cam) + matrix_line("Tr_imu_velo", imu_velo);
}

}  // namespace

KittiTrackingWriter::KittiTrackingWriter(const fs::path& folder,
                                         int sequence,
                                         KittiTrackingSetup setup)
    : staged_(folder), sequence_(four_digits(sequence)), setup_(checked_setup(std::move(setup))) {
  expect_unused(staged_.folder() / kRoot / "calib" / (sequence_ + ".txt"));
  write_bytes(staged_.file(kRoot / "calib" / (sequence_ + ".txt")), calibration_text(setup_));
}

void KittiTrackingWriter::add(const KittiTrackingFrame& frame) {
  const int number = static_cast<int>(poses_.size());
  const ImageWish wish{setup_.pair.image_size_px, true};
  check_image(frame.images.left, wish, number, "left image");
  check_image(frame.images.right, wish, number, "right image");
  check_rigid(frame.T_map_body, number, "T_map_body");
  if (frame.scan) {
    check_scan(*frame.scan, number);
  }
  const Pose T_left_map = (frame.T_map_body * T_body_left(setup_.pair)).inverse();
  std::string labels;
  for (const SceneObject& object : frame.objects) {
    check(object, number);
    labels +=
        label_line(object, number, T_left_map * object.T_map_object, left_camera_of(setup_.pair))
            .value_or("");
  }
  const fs::path image = fs::path(sequence_) / frame_file_name(number, ".png");
  write_png(staged_.file(kRoot / "image_02" / image), frame.images.left);
  write_png(staged_.file(kRoot / "image_03" / image), frame.images.right);
  if (frame.scan && !frame.scan->points_m.empty()) {
    const fs::path scan = fs::path(sequence_) / frame_file_name(number, ".bin");
    write_velodyne(staged_.file(kRoot / "velodyne" / scan), *frame.scan);
  }
  labels_ += labels;
  poses_.push_back(frame.T_map_body);
}

void KittiTrackingWriter::finish() {
  if (poses_.empty()) {
    throw Error(ErrorKind::kInput, "sequence " + sequence_ + ": expected at least one frame");
  }
  const fs::path text = sequence_ + ".txt";
  write_bytes(staged_.file(kRoot / "oxts" / text), oxts_text(poses_));
  write_bytes(staged_.file(kRoot / "label_02" / text), labels_);
  (void)staged_.file(kRoot / "velodyne" / sequence_ / "scan");  // the folder, even without a scan
  staged_.commit({kRoot / "image_02" / sequence_,
                  kRoot / "image_03" / sequence_,
                  kRoot / "velodyne" / sequence_,
                  kRoot / "oxts" / text,
                  kRoot / "label_02" / text,
                  kRoot / "calib" / text});
}

}  // namespace skyhalo
