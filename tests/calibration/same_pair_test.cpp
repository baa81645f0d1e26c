// The same pair of cameras as every program would write it, imported from each of them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iomanip>
#include <opencv2/calib3d.hpp>
#include <sstream>

#include "calibration/bad_input.hpp"
#include "skyhalo/calibration/calibration_import.hpp"

namespace skyhalo {
namespace {

using testing::expect_matrix;
using testing::TempFolder;
using Files = std::vector<std::filesystem::path>;
using Four = std::array<double, 4>;

const cv::Size kSize(752, 480);

/// The camera and its place, as the truth behind all the files.
struct Camera {
  Four intrinsics;
  Four distortion;
  Pose T_imu_camera;
};

struct Pair {
  bool fisheye = false;
  Camera left;
  Camera right;

  [[nodiscard]] Pose T_right_left() const {
    return right.T_imu_camera.inverse() * left.T_imu_camera;
  }
};

Pose pose(const Eigen::Vector3d& axis, double angle_rad, const Eigen::Vector3d& t_m) {
  return make_pose(Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix(), t_m);
}

Pair true_pair(bool fisheye) {
  const Pose T_imu_rig = pose({0.02, -0.03, 1.0}, 1.55, {-0.02, -0.06, 0.01});
  return {fisheye,
          {{458.654, 457.296, 367.215, 248.375},
           {-0.0283, 0.0739, 0.000193, 1.76e-05},
           T_imu_rig * pose({0.3, 0.4, -0.2}, 0.012, {0.0, 0.0, 0.0})},
          {{457.587, 456.134, 379.999, 255.238},
           {-0.0287, 0.0745, -0.000104, -3.55e-05},
           T_imu_rig * pose({-0.1, 0.5, 0.3}, 0.021, {0.11, 0.002, -0.001})}};
}

/// Numbers with all their digits, separated by `, `.
template <class Numbers>
std::string list(const Numbers& numbers) {
  std::ostringstream text;
  text << std::setprecision(17);
  const char* separator = "";
  for (const double number : numbers) {
    text << separator << number;
    separator = ", ";
  }
  return text.str();
}

std::string rows(const Eigen::MatrixXd& matrix) {
  const Eigen::MatrixXd transposed = matrix.transpose();
  return list(transposed.reshaped());
}

Eigen::Matrix3d camera_matrix(const Camera& camera) {
  const auto& [fx, fy, cx, cy] = camera.intrinsics;
  Eigen::Matrix3d K;
  K << fx, 0, cx, 0, fy, cy, 0, 0, 1;
  return K;
}

std::string kalibr_camera(const Pair& pair, const Camera& camera, const std::string& chain) {
  const Pose T_camera_imu = camera.T_imu_camera.inverse();
  std::string text = "  T_cam_imu:\n";
  for (int row = 0; row < 4; ++row) {
    text += "  - [" + rows(T_camera_imu.matrix().row(row)) + "]\n";
  }
  return text + chain + "  cam_overlaps: [0]\n  camera_model: pinhole\n  distortion_coeffs: [" +
         list(camera.distortion) +
         "]\n  distortion_model: " + (pair.fisheye ? "equidistant" : "radtan") +
         "\n  intrinsics: [" + list(camera.intrinsics) +
         "]\n  resolution: [752, 480]\n  rostopic: /cam/image_raw\n"
         "  timeshift_cam_imu: 0.001\n";
}

Files write_kalibr(const Pair& pair, const TempFolder& folder) {
  std::string chain = "  T_cn_cnm1:\n";
  for (int row = 0; row < 4; ++row) {
    chain += "  - [" + rows(pair.T_right_left().matrix().row(row)) + "]\n";
  }
  return {folder.write("camchain-imucam.yaml",
                       "cam0:\n" + kalibr_camera(pair, pair.left, "") + "cam1:\n" +
                           kalibr_camera(pair, pair.right, chain))};
}

std::string euroc_sensor(const Pair& pair, const Camera& camera) {
  return "#Default imu sensor yaml file\nsensor_type: camera\ncomment: cam\n\nT_BS:\n  cols: 4\n"
         "  rows: 4\n  data: [" +
         rows(camera.T_imu_camera.matrix()) +
         "]\nrate_hz: 20\nresolution: [752, 480]\ncamera_model: pinhole\nintrinsics: [" +
         list(camera.intrinsics) + "] #fu, fv, cu, cv\ndistortion_model: " +
         (pair.fisheye ? "equidistant" : "radial-tangential") + "\ndistortion_coefficients: [" +
         list(camera.distortion) + "]\n";
}

Files write_euroc(const Pair& pair, const TempFolder& folder) {
  return {folder.write("mav0/cam0/sensor.yaml", euroc_sensor(pair, pair.left)),
          folder.write("mav0/cam1/sensor.yaml", euroc_sensor(pair, pair.right))};
}

/// A matrix as OpenCV names it, and its shape and numbers.
struct Named {
  std::string name;
  Eigen::Index rows;
  Eigen::Index cols;
  std::string numbers;
};

/// Five radial-tangential coefficients, as cv::stereoCalibrate writes, and four of the fisheye.
std::vector<Named> opencv_matrices(const Pair& pair) {
  const std::string k3 = pair.fisheye ? "" : ", 0.";
  const Eigen::Index coefficients = pair.fisheye ? 4 : 5;
  return {{"M1", 3, 3, rows(camera_matrix(pair.left))},
          {"D1", 1, coefficients, list(pair.left.distortion) + k3},
          {"M2", 3, 3, rows(camera_matrix(pair.right))},
          {"D2", 1, coefficients, list(pair.right.distortion) + k3},
          {"R", 3, 3, rows(pair.T_right_left().linear())},
          {"T", 3, 1, rows(pair.T_right_left().translation())}};
}

Files write_opencv_yml(const Pair& pair, const TempFolder& folder) {
  std::string intrinsics = "%YAML:1.0\n---\nimage_size: [ 752, 480 ]\n";
  intrinsics += pair.fisheye ? "distortion_model: fisheye\n" : "";
  std::string extrinsics = "%YAML:1.0\n---\n";
  for (const Named& matrix : opencv_matrices(pair)) {
    (matrix.name.size() == 2 ? intrinsics : extrinsics) +=
        matrix.name + ": !!opencv-matrix\n   rows: " + std::to_string(matrix.rows) +
        "\n   cols: " + std::to_string(matrix.cols) + "\n   dt: d\n   data: [ " + matrix.numbers +
        " ]\n";
  }
  return {folder.write("intrinsics.yml", intrinsics), folder.write("extrinsics.yml", extrinsics)};
}

Files write_opencv_xml(const Pair& pair, const TempFolder& folder) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<opencv_storage>\n<imageSize>\n  752 480</imageSize>\n";
  text += pair.fisheye ? "<distortion_model>equidistant</distortion_model>\n" : "";
  for (const Named& matrix : opencv_matrices(pair)) {
    std::string numbers = matrix.numbers;
    std::erase(numbers, ',');
    text += "<" + matrix.name + " type_id=\"opencv-matrix\">\n  <rows>" +
            std::to_string(matrix.rows) + "</rows>\n  <cols>" + std::to_string(matrix.cols) +
            "</cols>\n  <dt>d</dt>\n  <data>\n    " + numbers + "</data></" + matrix.name + ">\n";
  }
  return {folder.write("stereo.xml", text + "</opencv_storage>\n")};
}

std::string ros_matrix(const std::string& name, int row_count, int col_count, std::string numbers) {
  return name + ":\n  rows: " + std::to_string(row_count) +
         "\n  cols: " + std::to_string(col_count) + "\n  data: [" + std::move(numbers) + "]\n";
}

std::string ros_info(const Pair& pair, const Camera& camera, const cv::Mat& R, const cv::Mat& P) {
  std::string coefficients = list(camera.distortion);
  coefficients += pair.fisheye ? "" : ", 0.000000";
  return "image_width: 752\nimage_height: 480\ncamera_name: narrow_stereo\n" +
         ros_matrix("camera_matrix", 3, 3, rows(camera_matrix(camera))) +
         "distortion_model: " + (pair.fisheye ? "equidistant" : "plumb_bob") + "\n" +
         ros_matrix("distortion_coefficients", 1, pair.fisheye ? 4 : 5, coefficients) +
         ros_matrix("rectification_matrix", 3, 3, list(cv::Mat_<double>(R))) +
         ros_matrix("projection_matrix", 3, 4, list(cv::Mat_<double>(P)));
}

cv::Mat to_cv(const Eigen::MatrixXd& matrix) {
  cv::Mat_<double> copy(static_cast<int>(matrix.rows()), static_cast<int>(matrix.cols()));
  for (int row = 0; row < copy.rows; ++row) {
    for (int col = 0; col < copy.cols; ++col) {
      copy(row, col) = matrix(row, col);
    }
  }
  return copy;
}

Files write_ros(const Pair& pair, const TempFolder& folder) {
  const cv::Mat none = cv::Mat::zeros(1, 4, CV_64F);
  cv::Mat R_left;
  cv::Mat R_right;
  cv::Mat P_left;
  cv::Mat P_right;
  cv::Mat Q;
  cv::stereoRectify(to_cv(camera_matrix(pair.left)),
                    none,
                    to_cv(camera_matrix(pair.right)),
                    none,
                    kSize,
                    to_cv(pair.T_right_left().linear()),
                    to_cv(pair.T_right_left().translation()),
                    R_left,
                    R_right,
                    P_left,
                    P_right,
                    Q,
                    cv::CALIB_ZERO_DISPARITY);
  return {folder.write("left.yaml", ros_info(pair, pair.left, R_left, P_left)),
          folder.write("right.yaml", ros_info(pair, pair.right, R_right, P_right))};
}

std::string basalt_pose(const Pose& T) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d t_m = T.translation();
  std::ostringstream text;
  text << std::setprecision(17) << R"({"px": )" << t_m.x() << R"(, "py": )" << t_m.y()
       << R"(, "pz": )" << t_m.z() << R"(, "qx": )" << q.x() << R"(, "qy": )" << q.y()
       << R"(, "qz": )" << q.z() << R"(, "qw": )" << q.w() << "}";
  return text.str();
}

std::string basalt_lens(const Pair& pair, const Camera& camera) {
  const std::vector<std::string> names = pair.fisheye
                                             ? std::vector<std::string>{"k1", "k2", "k3", "k4"}
                                             : std::vector<std::string>{"k1", "k2", "p1", "p2"};
  const auto& [fx, fy, cx, cy] = camera.intrinsics;
  std::ostringstream text;
  text << std::setprecision(17) << R"({"camera_type": ")"
       << (pair.fisheye ? "kb4" : "pinhole-radtan8") << R"(", "intrinsics": {"fx": )" << fx
       << R"(, "fy": )" << fy << R"(, "cx": )" << cx << R"(, "cy": )" << cy;
  for (std::size_t i = 0; i < 4; ++i) {
    text << ", \"" << names[i] << "\": " << camera.distortion[i];
  }
  text << (pair.fisheye ? "" : R"(, "k3": 0, "k4": 0, "k5": 0, "k6": 0, "rpmax": 2.7)") << "}}";
  return text.str();
}

Files write_basalt(const Pair& pair, const TempFolder& folder) {
  return {folder.write("calibration.json",
                       R"({"value0": {"T_imu_cam": [)" + basalt_pose(pair.left.T_imu_camera) +
                           ", " + basalt_pose(pair.right.T_imu_camera) + R"(], "intrinsics": [)" +
                           basalt_lens(pair, pair.left) + ", " + basalt_lens(pair, pair.right) +
                           R"(], "resolution": [[752, 480], [752, 480]]}})")};
}

void expect_camera(const RawCamera& actual, const Camera& expected, bool fisheye) {
  EXPECT_EQ(actual.size_px, kSize);
  const Intrinsics& k = intrinsics(actual.lens);
  expect_matrix(Eigen::Vector4d(k.fx_px, k.fy_px, k.cx_px, k.cy_px),
                Eigen::Vector4d(expected.intrinsics.data()),
                1e-9);
  ASSERT_EQ(std::holds_alternative<KannalaBrandtLens>(actual.lens), fisheye);
  std::vector<double> wanted(expected.distortion.begin(), expected.distortion.end());
  std::vector<double> found;
  if (fisheye) {
    const auto& distortion = std::get<KannalaBrandtLens>(actual.lens).distortion();
    found.assign(distortion.begin(), distortion.end());
  } else {
    const auto& distortion = std::get<RadialTangentialLens>(actual.lens).distortion();
    found.assign(distortion.begin(), distortion.end());
    wanted.resize(8, 0.0);
  }
  EXPECT_THAT(found, ::testing::Pointwise(::testing::DoubleNear(1e-9), wanted));
}

/// How one program writes a pair, and what that is.
struct Program {
  Files (*write)(const Pair&, const TempFolder&) = nullptr;
  CalibrationFormat format = CalibrationFormat::kAuto;
};

void expect_same(const ImportResult& result, const Pair& pair) {
  EXPECT_THAT(result.warnings, ::testing::IsEmpty());
  ASSERT_EQ(result.rig.pairs.size(), 1U);
  const PairDescription& imported = result.rig.pairs[0];
  const RawPair& cameras = std::get<RawPairDescription>(imported.images).cameras;
  expect_camera(cameras.left, pair.left, pair.fisheye);
  expect_camera(cameras.right, pair.right, pair.fisheye);
  expect_matrix(cameras.T_right_left.matrix(), pair.T_right_left().matrix(), 1e-9);
  // The right camera looks forward: its right is the body's -y, its down the body's -z.
  Eigen::Matrix4d T_body_camera;
  T_body_camera << 0, 0, 1, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 1;
  expect_matrix(imported.T_body_camera.matrix(), T_body_camera, 1e-9);
}

void expect_from_every_program(const Pair& pair) {
  for (const Program& program : {Program{write_kalibr, CalibrationFormat::kKalibr},
                                 Program{write_euroc, CalibrationFormat::kEuroc},
                                 Program{write_opencv_yml, CalibrationFormat::kOpencv},
                                 Program{write_opencv_xml, CalibrationFormat::kOpencv},
                                 Program{write_ros, CalibrationFormat::kRos},
                                 Program{write_basalt, CalibrationFormat::kBasalt}}) {
    SCOPED_TRACE(name_of(program.format));
    const TempFolder folder;
    const ImportResult result =
        import_calibration(program.write(pair, folder), {.mounting = {.body_at_imu = false}});
    EXPECT_EQ(result.format, program.format);
    expect_same(result, pair);
  }
}

TEST(SamePairTest, ARadialTangentialPairComesOutOfEveryFormat) {
  expect_from_every_program(true_pair(false));
}

TEST(SamePairTest, AKannalaBrandtPairComesOutOfEveryFormat) {
  expect_from_every_program(true_pair(true));
}

}  // namespace
}  // namespace skyhalo
