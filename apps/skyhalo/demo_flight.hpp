#pragma once

#include <memory>
#include <string>
#include <vector>

#include "exact_map.hpp"
#include "skyhalo/config/config.hpp"
#include "skyhalo/evaluation/tolerant_score.hpp"
#include "skyhalo/io/contact_sheet.hpp"
#include "skyhalo/map/local_map.hpp"
#include "skyhalo/pipeline/obstacle_detector.hpp"
#include "stage_clock.hpp"

namespace skyhalo::app {

/// How far one pair's disparities are from the exact ones, over the frames that were looked at.
struct DisparityScore {
  std::string pair;
  double median_px = 0.0;  ///< of the absolute error, where the left camera sees the point, too
  double outliers = 0.0;   ///< share of these with an error above 2 px
  double density = 0.0;    ///< share of all pixels that have a disparity
};

/// What is kept of a frame.
struct DemoRow {
  int frame = 0;
  double render_s = 0.0;
  double process_ms = 0.0;  ///< all that would run on board
  TolerantScore score{};    ///< of the map so far, against the cells seen so far
};

/// A simulated flight through the whole method, as it would run on board, scored against what is
/// really there.
class DemoFlight {
 public:
  /// The flight must outlive this.
  DemoFlight(const SimulatedFlight& flight, const Config& config);

  /// Runs all frames, one after the other: what is timed does not share the processor with the
  /// simulator.
  void run(bool quiet);

  [[nodiscard]] const std::vector<DemoRow>& rows() const noexcept { return rows_; }

  [[nodiscard]] const std::vector<DisparityScore>& disparities() const noexcept {
    return disparities_;
  }

  /// Pictures of what was seen in the middle of the flight, and of the maps at its end.
  [[nodiscard]] const std::vector<TitledPicture>& pictures() const noexcept { return pictures_; }

  /// Samples of the flown path in a cell that the map calls occupied at the end.
  [[nodiscard]] int flown_through_occupied() const;

  [[nodiscard]] const DenseMap& map() const { return detector_->dense_map(); }

  [[nodiscard]] const LocalMap& local_map() const noexcept { return local_map_; }

  [[nodiscard]] const ExactMap& exact() const noexcept { return exact_; }

  [[nodiscard]] std::vector<StageTimes> stages() const { return clock_.times(); }

  /// Pixels of all images, both cameras.
  [[nodiscard]] double pixels_per_frame() const noexcept;

 private:
  void process(int frame, const FrameSet& frames);
  void compare_disparities(int frame);
  void keep_view(const FrameSet& frames, const Eigen::Matrix3d& R_map_body);
  void keep_maps();
  [[nodiscard]] TolerantScore score() const;

  const SimulatedFlight& flight_;
  Config config_;
  ExactMap exact_;
  std::unique_ptr<ObstacleDetector> detector_;  // both hold vectors, which ask for room
  LocalMap local_map_;
  std::unique_ptr<ScanIntegrator> local_integrator_;
  StageClock clock_;
  std::vector<DemoRow> rows_;
  std::vector<std::vector<float>> errors_px_;  // per pair
  std::vector<double> measured_share_;         // per pair, summed
  int compared_ = 0;
  std::vector<DisparityScore> disparities_;
  std::vector<TitledPicture> pictures_;
};

}  // namespace skyhalo::app
