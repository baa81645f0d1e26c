#include <benchmark/benchmark.h>

#include <opencv2/core/utility.hpp>

#include "skyhalo/stereo/matcher.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

/// One thread; arguments: width, height, disparities, paths.
void match(benchmark::State& state) {
  cv::setNumThreads(1);
  const cv::Size size(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const testing::TexturedPair pair = testing::textured_pair(size, 20, 1);
  Matcher matcher({.max_disparity_px = static_cast<int>(state.range(2)),
                   .paths = static_cast<int>(state.range(3))});
  cv::Mat1f disparity;
  while (state.KeepRunning()) {
    matcher.match(pair.left, pair.right, disparity);
    benchmark::DoNotOptimize(disparity.data);
  }
  const double evaluations = static_cast<double>(size.area()) * static_cast<double>(state.range(2));
  state.counters["MDE/s"] =
      benchmark::Counter(evaluations * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(match)
    ->ArgNames({"width", "height", "disparities", "paths"})
    ->Args({621, 187, 64, 3})
    ->Args({621, 187, 64, 8})
    ->Args({640, 360, 64, 3})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace skyhalo
