#include "skyhalo/rectify/rectifier.hpp"

#include <opencv2/imgproc.hpp>
#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

std::string size_text(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

void check_image(const cv::Mat& image, const char* side, const cv::Size& expected) {
  const bool depth_ok = image.depth() == CV_8U || image.depth() == CV_16U;
  const bool channels_ok = image.channels() == 1 || image.channels() == 3 || image.channels() == 4;
  if (image.empty() || !depth_ok || !channels_ok) {
    throw Error(ErrorKind::kInput, "stereo image: expected 8 or 16 bit, grey or colour, not empty");
  }
  if (image.size() != expected) {
    throw Error(ErrorKind::kInput,
                std::string("stereo pair: the ") + side + " image has " + size_text(image.size()) +
                    " pixels, the rig says " + size_text(expected));
  }
}

/// An 8-bit grey view of an image; the buffers hold what had to be converted.
cv::Mat1b to_grey(const cv::Mat& image, cv::Mat& grey, cv::Mat& grey_8bit) {
  cv::Mat one_channel = image;
  if (image.channels() != 1) {
    cv::cvtColor(image, grey, image.channels() == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
    one_channel = grey;
  }
  if (one_channel.depth() == CV_16U) {
    one_channel.convertTo(grey_8bit, CV_8U, 1.0 / 256.0);
    return grey_8bit;
  }
  return one_channel;
}

}  // namespace

Rectifier::Rectifier(const StereoPair& pair, int factor)
    : factor_(factor),
      left_{left_image_size_px(pair), {}, {}, {}, {}},
      right_{right_image_size_px(pair), {}, {}, {}, {}} {
  if (factor < 1) {
    throw Error(ErrorKind::kInput, "matching.downscale: expected a whole number above 0");
  }
  const cv::Size matched(pair.image_size_px.width / factor, pair.image_size_px.height / factor);
  if (matched.empty()) {
    throw Error(ErrorKind::kInput,
                "pair " + pair.name + ": its images are smaller than the down-scaling factor");
  }
  if (!pair.raw) {
    return;
  }
  const PairModel model = downscaled(pair.model, factor);
  left_.remapper.emplace(RemapGoal{pair.raw->left, pair.raw->R_left_cam, model, matched});
  right_.remapper.emplace(RemapGoal{pair.raw->right, pair.raw->R_right_cam, model, matched});
  pair_.left_valid = left_.remapper->valid();
  pair_.right_valid = right_.remapper->valid();
}

const RectifiedPair& Rectifier::rectify(const StereoImages& images) {
  check_image(images.left, "left", left_.size_px);
  check_image(images.right, "right", right_.size_px);
  bring(images.left, left_, pair_.left);
  bring(images.right, right_, pair_.right);
  return pair_;
}

void Rectifier::bring(const cv::Mat& image, Side& side, cv::Mat1b& out) const {
  const cv::Mat1b grey = to_grey(image, side.grey, side.grey_8bit);
  if (side.remapper) {
    side.remapper->remap(grey, out);
    return;
  }
  side.block_mean.shrink(grey, factor_, out);
}

}  // namespace skyhalo
