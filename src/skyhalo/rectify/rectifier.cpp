#include "skyhalo/rectify/rectifier.hpp"

#include <opencv2/imgproc.hpp>
#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

std::string size_text(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

void check_image(const cv::Mat& image) {
  const bool depth_ok = image.depth() == CV_8U || image.depth() == CV_16U;
  const bool channels_ok = image.channels() == 1 || image.channels() == 3 || image.channels() == 4;
  if (image.empty() || !depth_ok || !channels_ok) {
    throw Error(ErrorKind::kInput, "stereo image: expected 8 or 16 bit, grey or colour, not empty");
  }
}

}  // namespace

Rectifier::Rectifier(int factor) : factor_(factor) {
  if (factor < 1) {
    throw Error(ErrorKind::kInput, "matching.downscale: expected a whole number above 0");
  }
}

const RectifiedPair& Rectifier::rectify(const StereoImages& images) {
  check_image(images.left);
  check_image(images.right);
  if (images.left.size() != images.right.size()) {
    throw Error(ErrorKind::kInput,
                "stereo pair: the left image has " + size_text(images.left.size()) +
                    " pixels, the right one " + size_text(images.right.size()));
  }
  if (images.left.cols < factor_ || images.left.rows < factor_) {
    throw Error(ErrorKind::kInput, "stereo pair: images smaller than the down-scaling factor");
  }
  bring(images.left, pair_.left);
  bring(images.right, pair_.right);
  return pair_;
}

void Rectifier::bring(const cv::Mat& image, cv::Mat1b& out) {
  cv::Mat grey = image;
  if (image.channels() != 1) {
    cv::cvtColor(image, grey_, image.channels() == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
    grey = grey_;
  }
  if (grey.depth() == CV_16U) {
    grey.convertTo(grey_8bit_, CV_8U, 1.0 / 256.0);
    grey = grey_8bit_;
  }
  if (factor_ == 1) {
    grey.copyTo(out);
    return;
  }
  const cv::Size size(grey.cols / factor_, grey.rows / factor_);
  const cv::Rect whole_blocks(0, 0, size.width * factor_, size.height * factor_);
  cv::resize(grey(whole_blocks), out, size, 0.0, 0.0, cv::INTER_AREA);
}

}  // namespace skyhalo
