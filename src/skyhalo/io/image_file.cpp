#include "skyhalo/io/image_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

constexpr std::string_view kPngStart("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view kJpegStart("\xFF\xD8\xFF", 3);
constexpr std::string_view kJpegEnd("\xFF\xD9", 2);

std::uint32_t big_endian(std::string_view bytes) noexcept {
  std::uint32_t value = 0;
  for (const char byte : bytes) {
    value = value << 8U | static_cast<unsigned char>(byte);
  }
  return value;
}

/// What is wrong with a PNG file as a container, empty if nothing: every chunk must be whole and
/// match its check sum up to the end mark. A decoder may return the part that it got, or print on
/// its own.
std::string png_fault(std::string_view bytes) {
  constexpr std::size_t kAroundData = 12;  // length, type and check sum, 4 bytes each
  std::string_view rest = bytes.substr(kPngStart.size());
  while (rest.size() >= kAroundData) {
    const std::size_t length = big_endian(rest.substr(0, 4));
    if (length > rest.size() - kAroundData) {
      break;
    }
    const std::string_view checked = rest.substr(4, length + 4);
    const auto* const data = reinterpret_cast<const Bytef*>(checked.data());
    if (crc32(0, data, static_cast<uInt>(checked.size())) !=
        big_endian(rest.substr(length + 8, 4))) {
      return "is damaged: a check sum does not match";
    }
    if (checked.starts_with("IEND")) {
      return "";
    }
    rest.remove_prefix(length + kAroundData);
  }
  return "is cut off: the end of the image is missing";
}

std::string fault_of(std::string_view bytes) {
  if (bytes.empty()) {
    return "is empty, expected an image";
  }
  if (bytes.starts_with(kPngStart)) {
    return png_fault(bytes);
  }
  if (bytes.starts_with(kJpegStart) && bytes.rfind(kJpegEnd) == std::string_view::npos) {
    return "is cut off: the end of the image is missing";
  }
  return "";
}

}  // namespace

cv::Mat read_image(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file);
  if (const std::string fault = fault_of(bytes); !fault.empty()) {
    throw input_error(file, fault);
  }
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  cv::Mat image;
  try {
    image = cv::imdecode(raw, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR);
  } catch (const cv::Exception& error) {
    throw input_error(file, "is damaged: " + error.err);
  }
  if (image.empty()) {
    throw input_error(file, "is no image that can be read, or is damaged");
  }
  return image;
}

std::string encode_png(const cv::Mat& image) {
  constexpr int kLargestPx = 1 << 20;
  std::vector<unsigned char> bytes;
  if (image.empty() || std::max(image.cols, image.rows) > kLargestPx ||
      !cv::imencode(".png", image, bytes)) {
    throw Error(ErrorKind::kFailure, "a picture cannot be encoded as PNG");
  }
  return {bytes.begin(), bytes.end()};
}

void write_png(const std::filesystem::path& file, const cv::Mat& image) {
  write_bytes(file, encode_png(image));
}

}  // namespace skyhalo
