#include "skyhalo/dataset/frame_checks.hpp"

#include <algorithm>

#include "skyhalo/io/image_file.hpp"

namespace skyhalo {
namespace {

constexpr double kRigidTolerance = 1e-6;

std::string size_text(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height) + " pixels";
}

}  // namespace

Error frame_error(int frame, std::string_view message) {
  return {ErrorKind::kInput, "frame " + std::to_string(frame) + ": " + std::string(message)};
}

bool is_rigid(const Pose& T) {
  return T.matrix().allFinite() && is_rotation(T.linear(), kRigidTolerance);
}

void check_rigid(const Pose& T, int frame, std::string_view what) {
  if (!is_rigid(T)) {
    throw frame_error(frame, std::string(what) + ": expected a finite rigid transform");
  }
}

void check_image(const cv::Mat& image, const ImageWish& wish, int frame, std::string_view what) {
  if (image.size() != wish.size_px) {
    throw frame_error(frame,
                      std::string(what) + " has " + size_text(image.size()) + ", expected " +
                          size_text(wish.size_px));
  }
  const bool wide = image.depth() == CV_16U && !wish.eight_bit_only;
  if ((image.depth() != CV_8U && !wide) || (image.channels() != 1 && image.channels() != 3)) {
    throw frame_error(frame,
                      std::string(what) + ": expected a grey or BGR image of 8 bits" +
                          (wish.eight_bit_only ? "" : " or 16"));
  }
}

void check_scan(const LaserReturns& scan, int frame) {
  const std::size_t count = scan.points_m.size();
  if (!scan.reflectances.empty() && scan.reflectances.size() != count) {
    throw frame_error(frame,
                      "scan: expected a reflectance for each of " + std::to_string(count) +
                          " points, found " + std::to_string(scan.reflectances.size()));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!scan.points_m[i].allFinite()) {
      throw frame_error(frame, "scan: point " + std::to_string(i) + " is not finite");
    }
  }
}

cv::Mat read_image_of_size(const std::filesystem::path& file, const cv::Size& size_px) {
  cv::Mat image = read_image(file);
  if (image.size() != size_px) {
    throw input_error(file, "has " + size_text(image.size()) + ", expected " + size_text(size_px));
  }
  return image;
}

std::string frame_file_name(int frame, std::string_view ending) {
  constexpr std::size_t kDigits = 6;
  std::string name = std::to_string(frame);
  name.insert(0, kDigits - std::min(kDigits, name.size()), '0');
  return name + std::string(ending);
}

}  // namespace skyhalo
