#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>

#include "skyhalo/base/error.hpp"
#include "skyhalo/dataset/velodyne_file.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// An input error of a frame that is to be written: `frame N: message`. Internal to this layer, as
/// all of this header.
[[nodiscard]] Error frame_error(int frame, std::string_view message);

/// Whether a transform is finite and rigid.
[[nodiscard]] bool is_rigid(const Pose& T);

/// Throws `frame_error` naming `what` when the transform is not finite or not rigid.
void check_rigid(const Pose& T, int frame, std::string_view what);

/// An image that is to be written.
struct ImageWish {
  cv::Size size_px;
  bool eight_bit_only = false;  ///< else 16 bits are as good
};

/// Throws `frame_error` naming `what` for an image of another size, of another depth, or with other
/// than one (grey) or three (BGR) channels.
void check_image(const cv::Mat& image, const ImageWish& wish, int frame, std::string_view what);

/// Throws `frame_error` for a scan that `write_velodyne` refuses.
void check_scan(const LaserReturns& scan, int frame);

/// Reads an image. Throws `Error` (input) naming the file when it cannot be read or has another
/// size.
[[nodiscard]] cv::Mat read_image_of_size(const std::filesystem::path& file,
                                         const cv::Size& size_px);

/// The six-digit name of a frame's file: 000012.png.
[[nodiscard]] std::string frame_file_name(int frame, std::string_view ending);

}  // namespace skyhalo
