#include <benchmark/benchmark.h>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/rectify/rectifier.hpp"

namespace skyhalo {
namespace {

StereoRig reference_rig() {
  return load_rig(SKYHALO_SOURCE_DIR "/config/rigs/matrice100.yaml");
}

/// Smooth random images, as a camera's are.
cv::Mat1b picture(const cv::Size& size, int seed) {
  cv::Mat1b image(size);
  cv::RNG(static_cast<std::uint64_t>(seed)).fill(image, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(image, image, {5, 5}, 0.0);
  return image;
}

std::vector<StereoImages> raw_images(const StereoRig& rig) {
  std::vector<StereoImages> images;
  for (const StereoPair& pair : rig.pairs) {
    images.push_back({picture(left_image_size_px(pair), 1), picture(right_image_size_px(pair), 2)});
  }
  return images;
}

/// All eight raw images of the reference platform to half size, on one thread.
void reference_rig_half_size(benchmark::State& state) {
  cv::setNumThreads(1);
  const StereoRig rig = reference_rig();
  const std::vector<StereoImages> images = raw_images(rig);
  std::vector<Rectifier> rectifiers;
  for (const StereoPair& pair : rig.pairs) {
    rectifiers.emplace_back(pair, 2);
  }
  while (state.KeepRunning()) {
    for (std::size_t i = 0; i < rectifiers.size(); ++i) {
      benchmark::DoNotOptimize(rectifiers[i].rectify(images[i]).left.data);
    }
  }
}

/// What one does with OpenCV alone: warp at full size with its look-up maps, then shrink.
void reference_rig_opencv_full_size(benchmark::State& state) {
  cv::setNumThreads(1);
  const StereoRig rig = reference_rig();
  const std::vector<StereoImages> images = raw_images(rig);
  std::vector<Remapper> full_size;
  for (const StereoPair& pair : rig.pairs) {
    const RawImaging& raw = *pair.raw;
    full_size.emplace_back(RemapGoal{raw.left, raw.R_left_cam, pair.model, pair.image_size_px});
    full_size.emplace_back(RemapGoal{raw.right, raw.R_right_cam, pair.model, pair.image_size_px});
  }
  cv::Mat1b whole;
  cv::Mat1b half;
  while (state.KeepRunning()) {
    for (std::size_t i = 0; i < full_size.size(); ++i) {
      full_size[i].remap(i % 2 == 0 ? images[i / 2].left : images[i / 2].right, whole);
      cv::resize(whole, half, {}, 0.5, 0.5, cv::INTER_AREA);
      benchmark::DoNotOptimize(half.data);
    }
  }
}

BENCHMARK(reference_rig_half_size)->Unit(benchmark::kMillisecond);
BENCHMARK(reference_rig_opencv_full_size)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace skyhalo
