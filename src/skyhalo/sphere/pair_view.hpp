#pragma once

#include <limits>
#include <numbers>
#include <opencv2/core/types.hpp>
#include <span>
#include <string>
#include <vector>

#include "skyhalo/sphere/cell_looks.hpp"
#include "skyhalo/sphere/pair_geometry.hpp"

namespace skyhalo {

/// When a place counts as seen.
struct SeenRule {
  double near_m = 1.0;     ///< from the body origin; nearer places are not asked for, > 0
  double min_share = 0.8;  ///< of the window's pixels that must be valid, in (0, 1]
  /// What is said of a cell's direction is said of all cells this far about it, to whole cells:
  /// near the edges of things a matcher sees what is behind.
  double window_rad = std::numbers::pi / 60.0;  ///< in [0, pi/4]
};

/// Throws `Error` (input) naming the key of section `section` whose value is outside its domain.
void check(const SeenRule& rule, const std::string& section);

/// Which cells of a grid the pixels of a pair look into, and through which of these the places
/// along a cell's ray are seen although the camera stands beside the body origin. Both are fixed by
/// the mounting, so they are worked out once.
class PairView {
 public:
  /// Throws `Error` (input) when the rule is outside its domain.
  PairView(const PairGeometry& pair,
           const cv::Size& image_size_px,
           const GridGeometry& grid,
           const SeenRule& rule);

  [[nodiscard]] std::span<const LookRun> runs(int image_row) const noexcept;

  /// Share of a cell's directions that lie within the image, in [0, 1].
  [[nodiscard]] double coverage(int cell) const noexcept {
    return coverage_[static_cast<std::size_t>(cell)];
  }

  /// For each cell the range (m, body) up to which every place from `near_m` on along its centre is
  /// seen, with nothing nearer on the way there; 0 where the first place is not. `looks` and
  /// `free_to_m` have an entry per cell.
  void find_free(std::span<const CellLooks> looks, std::span<float> free_to_m) noexcept;

 private:
  /// From this range on, a cell's places are seen through cell `look` (-1: through none).
  struct Place {
    float begin_m;
    int look;
  };

  /// A cell's places, and where its ray runs past the camera.
  struct CellRay {
    int first_place;
    int end_place;
    float along_m;    ///< of the camera's offset along the ray
    float aside2_m2;  ///< squared distance between the camera and the ray's line
  };

  void find_runs(const PairGeometry& pair, const cv::Size& image_size_px);
  void find_coverage(const PairGeometry& pair, const cv::Size& image_size_px);
  void find_places(const Eigen::Vector3d& camera_m);
  [[nodiscard]] int column_reach(int row) const noexcept;
  void see_through_windows(std::span<const CellLooks> looks) noexcept;
  [[nodiscard]] CellLooks row_window(std::span<const CellLooks> looks,
                                     GridCell cell,
                                     int reach) const noexcept;
  [[nodiscard]] float seen_to(const CellLooks& own, GridCell cell) const noexcept;
  [[nodiscard]] float free_along(const CellRay& ray) const noexcept;

  GridGeometry grid_;
  SeenRule rule_;
  float max_range_m_;
  std::vector<LookRun> runs_;
  std::vector<int> row_begin_;  // of the runs of each image row, and the end
  std::vector<double> coverage_;
  std::vector<Place> places_;
  std::vector<CellRay> rays_;
  std::vector<CellLooks> rows_seen_;  // the looks of each cell's window along its row
  std::vector<float> seen_to_m_;  // of each look cell in this frame, from the camera; -1 if unseen
};

}  // namespace skyhalo
