#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <string_view>

#include "support/textured_pair.hpp"

namespace skyhalo::testing {

/// A made-up drive in KITTI's raw layout: the vehicle goes straight ahead towards a wall that
/// stands across its way. The map frame is the body's at frame 0: x ahead, y left, z up.
struct SyntheticDrive {
  int frames = 4;
  cv::Size image_size_px{320, 96};
  double focal_px = 256.0;
  double principal_u_px = 160.0;
  double principal_v_px = 48.0;
  double baseline_m = 0.5;
  double wall_x_m = 9.25;   ///< of the wall, map frame
  double step_m = 0.5;      ///< forward from frame to frame
  bool colour_too = false;  ///< cameras 02 and 03 with the same pictures in colour
};

/// Where the files of a written drive are.
struct DrivePaths {
  std::filesystem::path day;     ///< holds the calibration
  std::filesystem::path drive;   ///< to be given to the program
  std::filesystem::path labels;  ///< a tracking label file that fits
};

/// The scanner in the body frame and the left grey camera in the scanner's, in m. The camera looks
/// ahead: its x is the scanner's -y, its y the scanner's -z, its z the scanner's x.
inline constexpr std::array<double, 3> kSyntheticLaserInBody{0.75, 0.0, 0.5};
inline constexpr std::array<double, 3> kSyntheticCameraInLaser{0.25, 0.25, -0.125};

/// Ten digits, as KITTI numbers its files.
inline std::string synthetic_name(int frame, const std::string& ending) {
  std::array<char, 16> digits{};
  std::snprintf(digits.data(), digits.size(), "%010d", frame);
  return digits.data() + ending;
}

inline void write_text(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

/// A number with so many decimals, filled up with zeros to `width` characters.
inline std::string fixed_decimals(double value, int width, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%0*.*f", width, decimals, value);
  return text.data();
}

/// The picture of the wall from a camera at (x, y, z) in the map frame.
inline cv::Mat1b wall_picture(const SyntheticDrive& drive, const cv::Vec3d& camera_m) {
  constexpr double kTexelsPerM = 24.0;  // a little coarser than the pixels at the start
  constexpr int kTexels = 1024;
  static const cv::Mat1b wall = texture({kTexels, kTexels}, 77);
  const double m_per_px = (drive.wall_x_m - camera_m[0]) / drive.focal_px;
  cv::Mat1f map_u(drive.image_size_px);
  cv::Mat1f map_v(drive.image_size_px);
  for (int v = 0; v < map_u.rows; ++v) {
    for (int u = 0; u < map_u.cols; ++u) {
      const double y_m = camera_m[1] - (u - drive.principal_u_px) * m_per_px;
      const double z_m = camera_m[2] - (v - drive.principal_v_px) * m_per_px;
      map_u(v, u) = static_cast<float>(0.5 * kTexels - y_m * kTexelsPerM);
      map_v(v, u) = static_cast<float>(0.5 * kTexels - z_m * kTexelsPerM);
    }
  }
  cv::Mat1b picture;
  cv::remap(wall, picture, map_u, map_v, cv::INTER_LINEAR, cv::BORDER_WRAP);
  return picture;
}

inline std::string projection_line(const SyntheticDrive& drive, int camera, double offset_m) {
  std::array<char, 400> text{};
  std::snprintf(text.data(),
                text.size(),
                "P_rect_0%d: %e 0.0 %e %e 0.0 %e %e 0.0 0.0 0.0 1.0 0.0\n",
                camera,
                drive.focal_px,
                drive.principal_u_px,
                -drive.focal_px * offset_m,
                drive.focal_px,
                drive.principal_v_px);
  return text.data();
}

inline void write_calibration(const SyntheticDrive& drive, const std::filesystem::path& day) {
  std::string cameras = "calib_time: 09-Jan-2012 13:57:47\ncorner_dist: 9.950000e-02\n";
  for (const int camera : {0, 1, 2, 3}) {
    cameras += "R_rect_0" + std::to_string(camera) + ": 1.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 1.0\n";
    cameras += projection_line(drive, camera, camera % 2 == 0 ? 0.0 : drive.baseline_m);
  }
  write_text(day / "calib_cam_to_cam.txt", cameras);
  // T is minus the rotated place of the camera: (-y, -z, x) of (0.25, 0.25, -0.125), with its sign
  // turned.
  write_text(day / "calib_velo_to_cam.txt",
             "calib_time: 15-Mar-2012 11:37:16\nR: 0 -1 0 0 0 -1 1 0 0\nT: 0.25 -0.125 -0.25\n"
             "delta_f: 0.0 0.0\ndelta_c: 0.0 0.0\n");
  write_text(day / "calib_imu_to_velo.txt",
             "calib_time: 25-May-2012 16:47:16\nR: 1 0 0 0 1 0 0 0 1\nT: -0.75 0 -0.5\n");
}

/// One INS line at latitude 0, where a degree of longitude is pi / 180 * 6378137 m, heading east.
inline std::string oxts_line(double x_m) {
  const double longitude_deg = 8.0 + x_m / (std::numbers::pi / 180.0 * 6378137.0);
  std::string line = "0.0 " + fixed_decimals(longitude_deg, 0, 13) + " 116.5 0 0 0";
  for (int i = 6; i < 30; ++i) {
    line += " 0";
  }
  return line + "\n";
}

/// The points of the wall as the scanner sees them from a body at x, every 0.25 m.
inline std::string wall_scan(const SyntheticDrive& drive, double body_x_m) {
  std::string bytes;
  for (int i = 0; i < 48 * 16; ++i) {
    const int column = i / 16;
    const double y_m = -5.875 + 0.25 * column;
    const double z_m = -1.875 + 0.25 * (i % 16);
    const std::array<float, 4> record{
        static_cast<float>(drive.wall_x_m - body_x_m - kSyntheticLaserInBody[0]),
        static_cast<float>(y_m),
        static_cast<float>(z_m - kSyntheticLaserInBody[2]),
        0.5F};
    std::array<char, sizeof(record)> raw{};
    std::memcpy(raw.data(), record.data(), raw.size());
    bytes.append(raw.data(), raw.size());
  }
  return bytes;
}

inline void write_images(const SyntheticDrive& drive,
                         const std::filesystem::path& folder,
                         int frame,
                         double body_x_m) {
  const cv::Vec3d left_m(body_x_m + kSyntheticLaserInBody[0] + kSyntheticCameraInLaser[0],
                         kSyntheticLaserInBody[1] + kSyntheticCameraInLaser[1],
                         kSyntheticLaserInBody[2] + kSyntheticCameraInLaser[2]);
  for (int camera = 0; camera < (drive.colour_too ? 4 : 2); ++camera) {
    const double to_the_right_m = camera % 2 == 0 ? 0.0 : drive.baseline_m;
    cv::Mat picture = wall_picture(drive, left_m - cv::Vec3d(0.0, to_the_right_m, 0.0));
    if (camera >= 2) {
      cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
    }
    const auto data = folder / ("image_0" + std::to_string(camera)) / "data";
    std::filesystem::create_directories(data);
    cv::imwrite((data / synthetic_name(frame, ".png")).string(), picture);
  }
}

inline void write_stamps(const SyntheticDrive& drive, const std::filesystem::path& folder) {
  std::string stamps;
  for (int frame = 0; frame < drive.frames; ++frame) {
    stamps +=
        "2011-09-26 13:02:" + fixed_decimals(std::fmod(25.0 + 0.125 * frame, 60.0), 12, 9) + "\n";
  }
  for (const char* const sensor :
       {"image_00", "image_01", "image_02", "image_03", "oxts", "velodyne_points"}) {
    if (std::filesystem::is_directory(folder / sensor)) {
      write_text(folder / sensor / "timestamps.txt", stamps);
    }
  }
}

/// A label line for a frame whose box has its bottom centre at (x, y, z) of camera 0, in m.
inline std::string label_line(int frame, const std::string& type, const std::string& box) {
  return std::to_string(frame) + " 0 " + type + " 0 0 -1.5 10.0 20.0 30.0 40.0 " + box + "\n";
}

/// Label text with one `DontCare` entry for each frame: nothing moves.
inline std::string still_labels(int frames) {
  std::string text;
  for (int frame = 0; frame < frames; ++frame) {
    text += std::to_string(frame) +
            " -1 DontCare -1 -1 -10.0 10.0 20.0 30.0 40.0 -1000 -1000 -1000 -10 -1 -1 -1\n";
  }
  return text;
}

/// Writes the whole drive below `root`.
inline DrivePaths write_drive(const SyntheticDrive& drive, const std::filesystem::path& root) {
  DrivePaths paths;
  paths.day = root / "2011_09_26";
  paths.drive = paths.day / "2011_09_26_drive_0099_sync";
  paths.labels = root / "label_02_0099.txt";
  write_calibration(drive, paths.day);
  for (int frame = 0; frame < drive.frames; ++frame) {
    const double x_m = frame * drive.step_m;
    write_images(drive, paths.drive, frame, x_m);
    write_text(paths.drive / "oxts/data" / synthetic_name(frame, ".txt"), oxts_line(x_m));
    write_text(paths.drive / "velodyne_points/data" / synthetic_name(frame, ".bin"),
               wall_scan(drive, x_m));
  }
  write_stamps(drive, paths.drive);
  write_text(paths.labels, still_labels(drive.frames));
  return paths;
}

}  // namespace skyhalo::testing
