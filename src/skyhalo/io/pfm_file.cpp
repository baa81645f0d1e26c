#include "skyhalo/io/pfm_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

static_assert(std::endian::native == std::endian::little,
              "floats are copied as they lie in memory");

constexpr int kLargestSide = 16384;

/// What stands before the pixels.
struct PfmHead {
  cv::Size size;
  bool big_endian = false;
  std::size_t length = 0;  ///< bytes, up to the first pixel
};

/// The next word, and in `at` the place after the one blank that ends it.
std::string_view next_word(std::string_view bytes, std::size_t& at) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t from = std::min(at, bytes.size());
  const std::size_t end = std::min(bytes.find_first_of(kBlanks, from), bytes.size());
  at = end + 1;
  return bytes.substr(from, end - from);
}

PfmHead parse_head(const std::filesystem::path& file, std::string_view bytes) {
  PfmHead head;
  if (next_word(bytes, head.length) != "Pf") {
    throw input_error(file, "is no grey PFM image; expected it to begin with 'Pf'");
  }
  const std::optional<int> width = parse_whole_number(next_word(bytes, head.length));
  const std::optional<int> height = parse_whole_number(next_word(bytes, head.length));
  const std::optional<double> scale = parse_number(next_word(bytes, head.length));
  const auto is_side = [](const std::optional<int>& side) {
    return side && *side >= 1 && *side <= kLargestSide;
  };
  if (!is_side(width) || !is_side(height) || !scale || *scale == 0.0) {
    throw input_error(file,
                      "expected a width and a height in 1..." + std::to_string(kLargestSide) +
                          " and a scale that is not 0 after 'Pf'");
  }
  head.size = {*width, *height};
  head.big_endian = *scale > 0.0;
  return head;
}

}  // namespace

cv::Mat1f read_pfm(const std::filesystem::path& file) {
  std::string bytes = read_bytes(file);
  const PfmHead head = parse_head(file, bytes);
  const std::size_t row_bytes = sizeof(float) * static_cast<std::size_t>(head.size.width);
  const std::size_t expected = head.length + row_bytes * static_cast<std::size_t>(head.size.height);
  if (bytes.size() != expected) {
    throw input_error(file,
                      "has " + std::to_string(bytes.size()) + " bytes, expected " +
                          std::to_string(expected) + " for " + std::to_string(head.size.width) +
                          "x" + std::to_string(head.size.height) + " pixels");
  }
  cv::Mat1f image(head.size);
  char* from = bytes.data() + head.length;
  for (int v = image.rows - 1; v >= 0; --v, from += row_bytes) {  // the last row comes first
    if (head.big_endian) {
      for (std::size_t i = 0; i < row_bytes; i += sizeof(float)) {
        std::reverse(from + i, from + i + sizeof(float));
      }
    }
    std::memcpy(image[v], from, row_bytes);
  }
  return image;
}

void write_pfm(const std::filesystem::path& file, const cv::Mat1f& image) {
  if (image.empty() || std::max(image.cols, image.rows) > kLargestSide) {
    throw Error(ErrorKind::kFailure,
                file.string() + ": a picture of this size cannot be written as PFM");
  }
  const std::size_t row_bytes = sizeof(float) * static_cast<std::size_t>(image.cols);
  std::string bytes =
      "Pf\n" + std::to_string(image.cols) + " " + std::to_string(image.rows) + "\n-1.0\n";
  const std::size_t head = bytes.size();
  bytes.resize(head + row_bytes * static_cast<std::size_t>(image.rows));
  char* to = bytes.data() + head;
  for (int v = image.rows - 1; v >= 0; --v, to += row_bytes) {
    std::memcpy(to, image[v], row_bytes);
  }
  write_bytes(file, bytes);
}

}  // namespace skyhalo
