#include <benchmark/benchmark.h>

#include <cmath>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "reference/naive_rectification.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/rectify/rectifier.hpp"

namespace skyhalo {
namespace {

constexpr int kFactor = 2;

const StereoRig& reference_rig() {
  static const StereoRig rig = load_rig(SKYHALO_SOURCE_DIR "/config/rigs/matrice100.yaml");
  return rig;
}

/// Texture of all sizes, coarse ones stronger, as the outdoors has it.
cv::Mat1b picture(const cv::Size& size, std::uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat1f sum(size, 128.0F);
  for (int cell_px = 1; cell_px <= 64; cell_px *= 2) {
    cv::Mat1f noise(size.height / cell_px + 2, size.width / cell_px + 2);
    random.fill(noise, cv::RNG::NORMAL, 0.0, 4.0 * std::sqrt(cell_px));
    cv::Mat1f smooth;
    cv::resize(noise, smooth, {}, cell_px, cell_px, cv::INTER_CUBIC);
    sum += smooth(cv::Rect(cv::Point(), size));
  }
  cv::Mat1b image;
  sum.convertTo(image, CV_8U);
  return image;
}

/// The eight raw images, left and right of each pair in turn.
const std::vector<cv::Mat1b>& raw_images() {
  static const std::vector<cv::Mat1b> images = [] {
    std::vector<cv::Mat1b> made;
    for (const StereoPair& pair : reference_rig().pairs) {
      made.push_back(picture(left_image_size_px(pair), made.size()));
      made.push_back(picture(right_image_size_px(pair), made.size()));
    }
    return made;
  }();
  return images;
}

RemapGoal left_goal(const StereoPair& pair, int factor) {
  return {pair.raw->left,
          pair.raw->R_left_cam,
          downscaled(pair.model, factor),
          {pair.image_size_px.width / factor, pair.image_size_px.height / factor}};
}

RemapGoal right_goal(const StereoPair& pair, int factor) {
  RemapGoal goal = left_goal(pair, factor);
  goal.camera = pair.raw->right;
  goal.R_raw_cam = pair.raw->R_right_cam;
  return goal;
}

/// What the image ought to be: each pixel the mean of 64 rays over its square, at full size.
cv::Mat1d exact_average(const RemapGoal& goal, const cv::Mat1b& raw) {
  reference::NaiveRectification naive;
  naive.matched_size_px = goal.size_px;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t col = 0; col < 3; ++col) {
      naive.R_raw_cam[row][col] = goal.R_raw_cam(static_cast<int>(row), static_cast<int>(col));
    }
  }
  const auto view = [&](const reference::NaiveImagePoint& pixel) -> reference::NaiveVector {
    const Eigen::Vector3d ray = ray_of(goal.model, pixel[0], pixel[1]);
    return {ray.x(), ray.y(), ray.z()};
  };
  const auto image_of = [&](const reference::NaiveVector& ray) -> reference::NaiveImagePoint {
    const auto at = project(goal.camera.lens, {ray[0], ray[1], ray[2]});
    return at ? reference::NaiveImagePoint{at->x(), at->y()}
              : reference::NaiveImagePoint{std::nan(""), std::nan("")};
  };
  return reference::naive_rectify(raw, naive, view, image_of);
}

/// Root mean square difference in grey levels from the exact averages of the front and the left
/// pair's left images.
template <class MakeImage>
double rms_error(const MakeImage& make_image) {
  static const std::vector<cv::Mat1d> exact = [] {
    std::vector<cv::Mat1d> images;
    for (const std::size_t pair : {0U, 1U}) {
      images.push_back(
          exact_average(left_goal(reference_rig().pairs[pair], kFactor), raw_images()[2 * pair]));
    }
    return images;
  }();
  double sum = 0.0;
  double count = 0.0;
  for (const std::size_t pair : {0U, 1U}) {
    const cv::Mat1b image = make_image(pair);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const double difference = image(v, u) - exact[pair](v, u);
        if (!std::isnan(difference)) {
          sum += difference * difference;
          count += 1.0;
        }
      }
    }
  }
  return std::sqrt(sum / count);
}

/// All eight raw images of the reference platform to half size, on one thread.
void reference_rig_half_size(benchmark::State& state) {
  cv::setNumThreads(1);
  const StereoRig& rig = reference_rig();
  const std::vector<cv::Mat1b>& images = raw_images();
  std::vector<Rectifier> rectifiers;
  for (const StereoPair& pair : rig.pairs) {
    rectifiers.emplace_back(pair, kFactor);
  }
  while (state.KeepRunning()) {
    for (std::size_t i = 0; i < rectifiers.size(); ++i) {
      benchmark::DoNotOptimize(rectifiers[i].rectify({images[2 * i], images[2 * i + 1]}).left.data);
    }
  }
  state.counters["rms_grey"] = rms_error([&](std::size_t pair) {
    return rectifiers[pair].rectify({images[2 * pair], images[2 * pair + 1]}).left.clone();
  });
}

/// OpenCV's look-up maps of the eight cameras, to images shrunk by the factor.
class OpencvMaps {
 public:
  explicit OpencvMaps(int factor) {
    for (const StereoPair& pair : reference_rig().pairs) {
      add(left_goal(pair, factor));
      add(right_goal(pair, factor));
    }
  }

  void remap(std::size_t image, cv::Mat1b& out) const {
    cv::remap(raw_images()[image], out, maps_[image], fractions_[image], cv::INTER_LINEAR);
  }

 private:
  void add(const RemapGoal& goal) {
    cv::Mat2f at(goal.size_px);
    for (int v = 0; v < at.rows; ++v) {
      for (int u = 0; u < at.cols; ++u) {
        const auto pixel = project(goal.camera.lens, goal.R_raw_cam * ray_of(goal.model, u, v));
        at(v, u) = pixel ? cv::Vec2f(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()))
                         : cv::Vec2f(-100.0F, -100.0F);
      }
    }
    cv::convertMaps(at, cv::noArray(), maps_.emplace_back(), fractions_.emplace_back(), CV_16SC2);
  }

  std::vector<cv::Mat> maps_;
  std::vector<cv::Mat> fractions_;
};

/// Times `make(image, out)` over the eight images and notes its error.
template <class Make>
void run_peer(benchmark::State& state, const Make& make) {
  cv::setNumThreads(1);
  cv::Mat1b out;
  while (state.KeepRunning()) {
    for (std::size_t i = 0; i < raw_images().size(); ++i) {
      make(i, out);
      benchmark::DoNotOptimize(out.data);
    }
  }
  state.counters["rms_grey"] = rms_error([&](std::size_t pair) {
    make(2 * pair, out);
    return out.clone();
  });
}

/// OpenCV's way: warp at full size, then shrink by area.
void reference_rig_opencv_full_size(benchmark::State& state) {
  const OpencvMaps maps(1);
  cv::Mat1b whole;
  run_peer(state, [&](std::size_t image, cv::Mat1b& out) {
    maps.remap(image, whole);
    cv::resize(whole, out, {}, 1.0 / kFactor, 1.0 / kFactor, cv::INTER_AREA);
  });
}

/// Bilinear look-up of each matched pixel's middle in the raw image: aliases.
void reference_rig_opencv_point_sampling(benchmark::State& state) {
  const OpencvMaps maps(kFactor);
  run_peer(state, [&](std::size_t image, cv::Mat1b& out) { maps.remap(image, out); });
}

BENCHMARK(reference_rig_half_size)->Unit(benchmark::kMillisecond);
BENCHMARK(reference_rig_opencv_full_size)->Unit(benchmark::kMillisecond);
BENCHMARK(reference_rig_opencv_point_sampling)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace skyhalo
