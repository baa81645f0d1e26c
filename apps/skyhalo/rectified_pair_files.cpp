#include "rectified_pair_files.hpp"

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/rectify/block_mean.hpp"
#include "skyhalo/stereo/grey_images.hpp"

namespace skyhalo::app {
namespace {

std::string size_text(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height) + " pixels";
}

std::string type_text(const cv::Mat& image) {
  return std::string(image.depth() == CV_8U ? "8" : "16") + "-bit " +
         (image.channels() == 1 ? "grey" : "colour");
}

cv::Mat read_side(const std::string& file) {
  cv::Mat image = read_image(file);
  if (image.depth() != CV_8U && image.depth() != CV_16U) {
    throw input_error(file, "expected an image of 8 or 16 bits a channel, without sign");
  }
  return image;
}

}  // namespace

StereoImages read_rectified_pair(const std::string& left, const std::string& right) {
  StereoImages pair{read_side(left), read_side(right)};
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    throw input_error(right, found + ", expected " + expected + " as in " + left);
  };
  if (pair.left.size() != pair.right.size()) {
    refuse("has " + size_text(pair.right.size()), size_text(pair.left.size()));
  }
  if (pair.left.type() != pair.right.type()) {
    refuse("is " + type_text(pair.right), type_text(pair.left));
  }
  return pair;
}

void check_room(const std::string& file, const cv::Size& size_px, const SearchRange& search) {
  const cv::Size matched = size_px / search.factor;
  if (matched.width > search.range_px && matched.height > 0) {
    return;
  }
  const int widest_px = (matched.width - 1) / kSearchStepPx * kSearchStepPx;
  const bool another_would_do = widest_px > 0 && matched.height > 0;
  throw input_error(
      file,
      "is too small to search " + std::to_string(search.range_px * search.factor) +
          " disparities: of " + size_text(size_px) + ", " + size_text(matched) + " are matched" +
          (another_would_do
               ? "; --max-disparity can be " + std::to_string(widest_px * search.factor)
               : ""));
}

StereoImages shrunk_grey(const StereoImages& pair, int factor) {
  GreyImages grey;
  grey.convert(pair.left, pair.right);
  BlockMean mean;
  cv::Mat1b left;
  cv::Mat1b right;
  mean.shrink(grey.left(), factor, left);
  mean.shrink(grey.right(), factor, right);
  return {left, right};
}

}  // namespace skyhalo::app
