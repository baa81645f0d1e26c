// The matcher beside OpenCV's, in the same run, on the same images, one thread each unless a row
// says otherwise; speed and error in one row. Writes the page docs/benchmarks.md.
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/utility.hpp>
#include <string>
#include <utility>
#include <vector>

#include "skyhalo/evaluation/disparity_error.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/stereo/grey_images.hpp"
#include "skyhalo/stereo/sgm/engine.hpp"
#include "skyhalo/stereo/sgm_matcher.hpp"
#include "support/instruction_set.hpp"
#include "support/stereo_scenes.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using testing::InstructionSet;
using testing::StereoScene;

struct SceneGroup {
  std::string name;
  std::string about;
  std::vector<StereoScene> scenes;
};

/// The middle of a KITTI pair, with the truth that stays within a search range of 64.
StereoScene cut_out(const StereoScene& whole) {
  const cv::Rect middle((whole.left.cols - 640) / 2, whole.left.rows - 360, 640, 360);
  StereoScene cut = whole;
  cut.left = whole.left(middle).clone();
  cut.right = whole.right(middle).clone();
  cut.truth_px = whole.truth_px(middle).clone();
  cut.max_disparity_px = 64;
  for (int v = 0; v < middle.height; ++v) {
    for (int u = 0; u < middle.width; ++u) {
      float& d = cut.truth_px(v, u);
      d = d < 63.0F && d <= static_cast<float>(u) ? d : std::nanf("");
    }
  }
  return cut;
}

/// What there is to match: recorded scenes, or without them a made-up one.
std::vector<SceneGroup> scene_groups() {
  if (!std::filesystem::exists(testing::recorded_data() / "kitti2012")) {
    const testing::TexturedPair pair = testing::textured_pair({640, 360}, 20, 1);
    return {{"640x360x64",
             "a made-up plane of texture, as there is no recorded data",
             {{"texture", pair.left, pair.right, cv::Mat1f(pair.left.size(), 20.0F)}}}};
  }
  const std::vector<StereoScene> roads = testing::kitti2012_scenes();
  SceneGroup cuts{"640x360x64",
                  "the middle of the three KITTI pairs, truth below 63 px; left-aligned, 3 px",
                  {}};
  std::transform(roads.begin(), roads.end(), std::back_inserter(cuts.scenes), cut_out);
  return {std::move(cuts),
          {"1242x375x128",
           "KITTI stereo 2012: 000027, 000074, 000138; left-aligned, not occluded, 3 px",
           roads},
          {"450x375x64",
           "Middlebury: cones, teddy, venus; right-aligned, not occluded, 1 px",
           testing::middlebury_scenes()}};
}

/// One matcher on one scene.
struct Contender {
  std::string name;
  int threads = 1;
  std::int64_t target = 0;    ///< instruction set; 0: not ours
  std::function<void()> run;  ///< the timed work alone
  std::function<cv::Mat1f()> disparity;
};

struct Result {
  std::string name;
  int threads = 1;
  double time_ms = 0.0;
  double density = 0.0;
  double bad = 0.0;
  double bad_or_unmatched = 0.0;
};

double now_ms() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(since).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Contender ours(const StereoScene& scene, const GreyImages& grey, std::int64_t target, int threads) {
  struct Work {
    SgmMatcher matcher;
    cv::Mat1f disparity;
  };

  MatcherConfig config;
  config.max_disparity_px = scene.max_disparity_px;
  config.alignment = scene.alignment;
  const auto work = std::make_shared<Work>(Work{SgmMatcher(config), {}});
  return {"skyhalo, " + InstructionSet::name(target),
          threads,
          target,
          [work, &grey] { work->matcher.match(grey.left(), grey.right(), work->disparity); },
          [work] { return work->disparity; }};
}

/// OpenCV's `compute` alone is timed; what turns its alignment is not.
Contender opencv(const StereoScene& scene, const GreyImages& grey, const char* name, int paths) {
  struct Work {
    cv::Ptr<cv::StereoSGBM> sgbm;
    cv::Mat1b first;
    cv::Mat1b second;
    cv::Mat fixed;
  };

  const auto mode = paths == 3 ? cv::StereoSGBM::MODE_SGBM_3WAY : cv::StereoSGBM::MODE_HH;
  const auto work = std::make_shared<Work>();
  work->sgbm =
      cv::StereoSGBM::create(0, scene.max_disparity_px, 3, 8 * 9, 32 * 9, 1, 63, 10, 100, 2, mode);
  const bool right = scene.alignment == Alignment::kRight;
  if (right) {
    cv::flip(grey.right(), work->first, 1);
    cv::flip(grey.left(), work->second, 1);
  } else {
    work->first = grey.left();
    work->second = grey.right();
  }
  return {name,
          1,
          0,
          [work] { work->sgbm->compute(work->first, work->second, work->fixed); },
          [work, right] {
            cv::Mat1f disparity;
            work->fixed.convertTo(disparity, CV_32F, 1.0 / 16.0);
            disparity.setTo(std::nanf(""), work->fixed < 0);
            if (right) {
              cv::flip(disparity, disparity, 1);
            }
            return disparity;
          }};
}

std::vector<Contender> contenders(const StereoScene& scene, const GreyImages& grey) {
  std::vector<Contender> all;
  const std::vector<std::int64_t> targets = InstructionSet::all();
  for (const std::int64_t target : targets) {
    if (target != HWY_SCALAR) {
      all.push_back(ours(scene, grey, target, 1));
    }
  }
  all.push_back(ours(scene, grey, targets.front(), 2));
  all.push_back(opencv(scene, grey, "OpenCV SGBM_3WAY", 3));
  all.push_back(opencv(scene, grey, "OpenCV HH (8 paths)", 8));
  return all;
}

double time_of(const Contender& contender) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(contender.threads));
  cv::setNumThreads(contender.threads);
  const InstructionSet instructions(contender.target);
  contender.run();  // the caches are its own, as they are from frame to frame
  const double start_ms = now_ms();
  contender.run();
  return now_ms() - start_ms;
}

/// All matchers take turns, so that what else the machine does troubles them alike; in its turn
/// each runs twice, and the second run counts. Adds to `results`, which are means over the scenes.
void measure(const StereoScene& scene, int repeat, double weight, std::vector<Result>& results) {
  GreyImages grey;
  grey.convert(scene.left, scene.right);
  const std::vector<Contender> all = contenders(scene, grey);
  results.resize(all.size());
  std::vector<std::vector<double>> times_ms(all.size());
  for (int turn = 0; turn <= repeat; ++turn) {  // the first one warms up
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double time_ms = time_of(all[i]);
      if (turn > 0) {
        times_ms[i].push_back(time_ms);
      }
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const DisparityError error =
        compare_disparity(all[i].disparity(), scene.truth_px, scene.threshold_px);
    results[i].name = all[i].name;
    results[i].threads = all[i].threads;
    results[i].time_ms += weight * median(times_ms[i]);
    results[i].density += weight * error.density();
    results[i].bad += weight * error.bad_among_matched();
    results[i].bad_or_unmatched += weight * error.bad_or_unmatched();
  }
}

const Result& result_of(const std::vector<Result>& results, const std::string& name) {
  return *std::find_if(
      results.begin(), results.end(), [&name](const Result& r) { return r.name == name; });
}

std::string table_of(const std::vector<Result>& results) {
  const double three_way_ms = result_of(results, "OpenCV SGBM_3WAY").time_ms;
  const double hh_ms = result_of(results, "OpenCV HH (8 paths)").time_ms;
  std::string text =
      "| matcher | threads | ms | × the speed of 3WAY | × that of HH | density | bad | bad or "
      "unmatched |\n|---|---|---|---|---|---|---|---|\n";
  for (const Result& r : results) {
    std::array<char, 200> line{};
    std::snprintf(line.data(),
                  line.size(),
                  "| %s | %d | %.1f | %.2f | %.2f | %.3f | %.2f %% | %.1f %% |\n",
                  r.name.c_str(),
                  r.threads,
                  r.time_ms,
                  three_way_ms / r.time_ms,
                  hh_ms / r.time_ms,
                  r.density,
                  100.0 * r.bad,
                  100.0 * r.bad_or_unmatched);
    text += line.data();
  }
  return text;
}

constexpr std::array kStageNames{"smoothed copies, texture",
                                 "census of both images",
                                 "rows to sweeps",
                                 "cost, 8 paths, winners of both images, sub-pixel, uniqueness",
                                 "sweeps to rows, left-right check",
                                 "3 medians of 5 x 5, holes filled",
                                 "speckles",
                                 "depth edges"};

class StageTimes final : public sgm::EngineListener {
 public:
  void start() { last_ms_ = now_ms(); }

  void done(sgm::EngineStage stage) override {
    const double ms = now_ms();
    times_ms_.at(static_cast<std::size_t>(stage)).push_back(ms - last_ms_);
    last_ms_ = ms;
  }

  [[nodiscard]] std::string table() const {
    std::string text = "| stage | ms |\n|---|---|\n";
    for (std::size_t i = 0; i < kStageNames.size(); ++i) {
      std::array<char, 120> line{};
      std::snprintf(
          line.data(), line.size(), "| %s | %.2f |\n", kStageNames.at(i), median(times_ms_.at(i)));
      text += line.data();
    }
    return text;
  }

 private:
  double last_ms_ = 0.0;
  std::array<std::vector<double>, kStageNames.size()> times_ms_;
};

std::string stages_of(const StereoScene& scene, int repeat) {
  GreyImages grey;
  grey.convert(scene.left, scene.right);
  sgm::Engine engine({}, {scene.left.cols, scene.left.rows, scene.max_disparity_px});
  cv::Mat1f disparity(scene.left.size());
  sgm::SerialExecutor executor;
  StageTimes times;
  for (int turn = 0; turn < repeat; ++turn) {
    times.start();
    engine.match({{grey.left()[0], static_cast<std::ptrdiff_t>(grey.left().step1())},
                  {grey.right()[0], static_cast<std::ptrdiff_t>(grey.right().step1())},
                  scene.alignment == Alignment::kLeft},
                 {disparity[0], static_cast<std::ptrdiff_t>(disparity.step1())},
                 executor,
                 &times);
  }
  return times.table();
}

std::string page_of(int repeat) {
  const std::vector<SceneGroup> groups = scene_groups();
  std::string page =
      "# Benchmarks\n\n"
      "## Matching\n\n"
      "Written by `build/release/bench/bench_matcher --repeat " +
      std::to_string(repeat) +
      " --markdown docs/benchmarks.md` (after `make bench`), from recorded\n"
      "scenes under `SKYHALO_DATA`. All matchers of a table take turns in one run, on the same "
      "images, with one\nthread unless the row says two; each runs twice in its turn, and the "
      "second run counts. Times are medians over the turns, then "
      "means over the scenes; errors are means\nover the scenes, of pixels whose truth is known. "
      "Ratios travel from machine to machine better than times do.\n\n"
      "Ours is the whole matcher with its default settings. OpenCV's has block 3, its documented "
      "penalties, uniqueness\n10, left-right check 1 px and speckles of 100 px; only its "
      "`compute` is timed.\n";
  for (const SceneGroup& group : groups) {
    std::cerr << "measuring " << group.name << '\n';
    std::vector<Result> results;
    for (const StereoScene& scene : group.scenes) {
      measure(scene, repeat, 1.0 / static_cast<double>(group.scenes.size()), results);
    }
    page += "\n### " + group.name + "\n\nImages: " + group.about + ".\n\n" + table_of(results);
  }
  page += "\n### The stages, " + groups.front().name + "\n\nOne thread, " +
          InstructionSet::name(InstructionSet::all().front()) + ", medians.\n\n" +
          stages_of(groups.front().scenes.front(), repeat);
  return page;
}

int run(int argc, char** argv) {
  CLI::App program("Times and scores the matcher beside OpenCV's");
  int repeat = 15;
  std::string markdown;
  program.add_option("--repeat", repeat, "turns that count")->check(CLI::Range(1, 1000));
  program.add_option("--markdown", markdown, "write the page to this file, not to stdout");
  CLI11_PARSE(program, argc, argv);
  const std::string page = page_of(repeat);
  if (markdown.empty()) {
    std::cout << page;
  } else {
    write_bytes(markdown, page);
  }
  return 0;
}

}  // namespace
}  // namespace skyhalo

int main(int argc, char** argv) {
  return skyhalo::run(argc, argv);
}
