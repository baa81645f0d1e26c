#include "skyhalo/io/image_file.hpp"

#include <opencv2/imgcodecs.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

/// A decoder may return the part of a PNG that it got, so the end of the file is looked at here.
bool is_cut_off(std::string_view bytes) {
  constexpr std::string_view kPngStart("\x89PNG\r\n\x1a\n", 8);
  constexpr std::string_view kPngEnd("\0\0\0\0IEND\xAE\x42\x60\x82", 12);
  constexpr std::string_view kJpegStart("\xFF\xD8\xFF", 3);
  constexpr std::string_view kJpegEnd("\xFF\xD9", 2);
  return (bytes.starts_with(kPngStart) && bytes.rfind(kPngEnd) == std::string_view::npos) ||
         (bytes.starts_with(kJpegStart) && bytes.rfind(kJpegEnd) == std::string_view::npos);
}

}  // namespace

cv::Mat read_image(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file);
  if (bytes.empty()) {
    throw input_error(file, "is empty, expected an image");
  }
  if (is_cut_off(bytes)) {
    throw input_error(file, "is cut off: the end of the image is missing");
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

void write_png(const std::filesystem::path& file, const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes)) {
    throw Error(ErrorKind::kFailure, file.string() + ": the image cannot be encoded");
  }
  write_bytes(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace skyhalo
