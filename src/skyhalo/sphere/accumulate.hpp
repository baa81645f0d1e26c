#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "skyhalo/sphere/pair_geometry.hpp"
#include "skyhalo/sphere/spherical_grid.hpp"

namespace skyhalo {

/// How many pixels of a disparity image became points.
struct PixelCounts {
  int measured = 0;  ///< pixels with a disparity
  int used = 0;      ///< of these, the ones that see something within the range limits
};

/// Adds disparity images of one pair to grids (thesis eq. 5.2, 5.3). Owns what the pair's mounting
/// fixes, and all memory that an image needs. Not for use by two threads at once.
class Accumulator {
 public:
  /// For images of this size, and grids of this geometry and depth rule. Throws `Error` (input)
  /// when a rule is outside its domain.
  Accumulator(const PairGeometry& pair,
              const cv::Size& image_size_px,
              const GridGeometry& grid,
              const DepthRule& depth = {},
              const SeenRule& seen = {});
  Accumulator(const Accumulator&) = delete;
  Accumulator& operator=(const Accumulator&) = delete;
  Accumulator(Accumulator&&) noexcept;
  Accumulator& operator=(Accumulator&&) noexcept;
  ~Accumulator();

  /// Adds every valid pixel of a disparity image (px, aligned with the right image, of the given
  /// size) to the grid, as the point `T_body_camera * reproject(u, v, d)`, and to the cell of its
  /// ray as one that looked there; then settles the grid. A disparity of 0, offset included, sees
  /// something infinitely far; NaN, infinite and negative ones see nothing. Points are placed
  /// within 1e-5 rad and 1e-5 of their range. The image's rows are shared among TBB's threads; the
  /// result has the same bits at any number of them. Throws `Error` (input) for another size, or a
  /// grid of another geometry or rule.
  PixelCounts accumulate(const cv::Mat1f& disparity, SphericalGrid& grid);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The same for a single image: works out the mounting anew, which takes far longer than the rest.
PixelCounts accumulate(const cv::Mat1f& disparity, const PairGeometry& pair, SphericalGrid& grid);

}  // namespace skyhalo
