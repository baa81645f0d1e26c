#include "demo_flight.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "interrupt.hpp"
#include "progress_bar.hpp"
#include "skyhalo/evaluation/comparison_picture.hpp"
#include "skyhalo/evaluation/ground_truth.hpp"
#include "skyhalo/io/halo_picture.hpp"
#include "skyhalo/io/picture.hpp"
#include "skyhalo/rectify/rectifier.hpp"

namespace skyhalo::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kCompareEvery = 6;  // frames whose disparities are compared with the exact ones
constexpr int kScoreEvery = 4;    // frames after which the map is scored
constexpr int kMapCellPx = 6;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

cv::Mat3b coloured(const cv::Mat1b& grey) {
  cv::Mat3b picture;
  cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
  return picture;
}

/// The local map as a map with bounds, for pictures.
DenseMap copy_of(const LocalMap& map) {
  const CellBox& bounds = map.bounds();
  DenseMap copy({map.lattice().corner_m(bounds.min), map.lattice().voxel_m, bounds.size()});
  for (std::int64_t i = 0; i < copy.grid().cell_count(); ++i) {
    copy.at(i) = map.at(Eigen::Vector3i(copy.grid().cell_at(i) + bounds.min));
  }
  return copy;
}

}  // namespace

DemoFlight::DemoFlight(const SimulatedFlight& flight, const Config& config)
    : flight_(flight),
      config_(config),
      exact_(flight, config.detector.map.voxel_m),
      detector_(std::make_unique<ObstacleDetector>(flight.rig(), config.detector, exact_.grid())),
      local_map_(make_local_map(config.detector.map)),
      local_integrator_(std::make_unique<ScanIntegrator>(integration_config(config.detector))),
      errors_px_(flight.rig().pairs.size()),
      measured_share_(flight.rig().pairs.size(), 0.0) {}

double DemoFlight::pixels_per_frame() const noexcept {
  double pixels = 0.0;
  for (const StereoPair& pair : flight_.rig().pairs) {
    pixels += left_image_size_px(pair).area() + right_image_size_px(pair).area();
  }
  return pixels;
}

TolerantScore DemoFlight::score() const {
  return tolerant_score(
      {exact_.grid(), detector_->dense_map().cells(), exact_.occupied(), exact_.seen()},
      config_.evaluation.occupied_probability);
}

void DemoFlight::process(int frame, const FrameSet& frames) {
  const Pose T_map_body = flight_.T_map_body(frame);
  detector_->process(frames, T_map_body, &clock_);
  local_map_.follow(T_map_body.translation());
  local_integrator_->integrate(detector_->scan(), T_map_body, local_map_);
}

void DemoFlight::compare_disparities(int frame) {
  ++compared_;
  for (std::size_t i = 0; i < flight_.rig().pairs.size(); ++i) {
    const int factor =
        flight_.rig().pairs[i].downscale.value_or(config_.detector.matching.downscale);
    const DepthTruth truth = flight_.truth(frame, i, factor);
    const cv::Mat1f& disparity = detector_->perception(i).disparity;
    std::size_t measured = 0;
    for (int row = 0; row < disparity.rows; ++row) {
      for (int col = 0; col < disparity.cols; ++col) {
        const float d_px = disparity(row, col);
        if (std::isnan(d_px)) {
          continue;
        }
        ++measured;
        if (truth.both(row, col) != 0) {
          errors_px_[i].push_back(std::abs(d_px - truth.disparity_px(row, col)));
        }
      }
    }
    measured_share_[i] += static_cast<double>(measured) / static_cast<double>(disparity.total());
  }
}

void DemoFlight::run(bool quiet) {
  const int frames = flight_.frame_count();
  ProgressBar bar("flying", frames, quiet);
  for (int frame = 0; frame < frames; ++frame) {
    stop_if_interrupted();
    DemoRow row{.frame = frame};
    Clock::time_point start = Clock::now();
    const FrameSet images = flight_.read(frame);
    row.render_s = seconds_since(start);
    start = Clock::now();
    process(frame, images);
    row.process_ms = 1e3 * seconds_since(start);
    exact_.look_from(frame, config_.detector.matching.downscale);
    if (frame % kCompareEvery == 0) {
      compare_disparities(frame);
    }
    if (frame % kScoreEvery == 0 || frame + 1 == frames) {
      row.score = score();
    }
    if (frame == frames / 2) {
      keep_view(images, flight_.T_map_body(frame).linear());
    }
    rows_.push_back(row);
    bar.advance();
  }
  keep_maps();
  for (std::size_t i = 0; i < errors_px_.size(); ++i) {
    std::vector<float>& errors_px = errors_px_[i];
    DisparityScore score{.pair = flight_.rig().pairs[i].name,
                         .density = measured_share_[i] / compared_};
    if (!errors_px.empty()) {
      const auto middle = errors_px.begin() + static_cast<std::ptrdiff_t>(errors_px.size() / 2);
      std::nth_element(errors_px.begin(), middle, errors_px.end());
      score.median_px = static_cast<double>(*middle);
      score.outliers = static_cast<double>(std::count_if(
                           errors_px.begin(), errors_px.end(), [](float e) { return e > 2.0F; })) /
                       static_cast<double>(errors_px.size());
    }
    disparities_.push_back(score);
  }
}

void DemoFlight::keep_view(const FrameSet& frames, const Eigen::Matrix3d& R_map_body) {
  for (std::size_t i = 0; i < flight_.rig().pairs.size(); ++i) {
    const StereoPair& pair = flight_.rig().pairs[i];
    const StereoImages& images = frames.pairs[i];
    Rectifier rectifier(pair, pair.downscale.value_or(config_.detector.matching.downscale));
    const RectifiedPair& rectified = rectifier.rectify(images);
    const std::string of = " (" + pair.name + " pair)";
    pictures_.push_back({"Raw right image" + of, images.right});
    pictures_.push_back({"Rectified right image" + of, coloured(rectified.right)});
    pictures_.push_back(
        {"Disparity, bright is near" + of, disparity_picture(detector_->perception(i).disparity)});
  }
  const int halo_cell_px = std::max(1, 1440 / detector_->halo().geometry().cols);
  pictures_.push_back({"Halo: the nearest in each direction, all pairs stitched",
                       halo_picture(detector_->halo(), halo_cell_px)});
  pictures_.push_back({"Halo from above, nose up, to 15 m",
                       halo_top_picture(detector_->halo(), {}, R_map_body, 15.0, 720)});
}

void DemoFlight::keep_maps() {
  const double p_occupied = config_.evaluation.occupied_probability;
  GroundTruth truth(exact_.grid());
  std::vector<std::int64_t> cells;
  for (std::size_t i = 0; i < exact_.occupied().size(); ++i) {
    if (exact_.occupied()[i] != 0 && exact_.seen()[i] != 0) {
      cells.push_back(static_cast<std::int64_t>(i));
    }
  }
  truth.mark(cells);
  truth.mark_observed(std::vector<std::uint8_t>(exact_.seen().begin(), exact_.seen().end()));
  pictures_.push_back(
      {"Global map from above, colour is height", top_picture(map(), p_occupied, kMapCellPx)});
  pictures_.push_back({"What is there and was seen within 15 m", truth_picture(truth, kMapCellPx)});
  DenseMap counted = map();
  for (std::int64_t i = 0; i < counted.grid().cell_count(); ++i) {
    if (exact_.seen()[static_cast<std::size_t>(i)] == 0) {
      counted.at(i) = kUnknown;
    }
  }
  pictures_.push_back({"Map against truth: found (green), only claimed (orange), missed (blue)",
                       comparison_picture(counted, truth, p_occupied, kMapCellPx)});
  pictures_.push_back({"Local map at the end, 8 by 8 m about the drone",
                       top_picture(copy_of(local_map_), p_occupied, 8 * kMapCellPx)});
}

int DemoFlight::flown_through_occupied() const {
  constexpr double kStepS = 0.005;
  const double p_occupied = config_.evaluation.occupied_probability;
  const double end_s = flight_.time_s(flight_.frame_count() - 1);
  int occupied = 0;
  const int steps = static_cast<int>(end_s / kStepS);
  for (int i = 0; i <= steps; ++i) {
    const double t_s = i * kStepS;
    const LogOdds cell = map().at_point(flight_.trajectory().T_map_body(t_s).translation());
    occupied += probability_of(cell) > p_occupied ? 1 : 0;
  }
  return occupied;
}

}  // namespace skyhalo::app
