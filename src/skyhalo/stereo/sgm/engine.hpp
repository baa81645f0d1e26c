#pragma once

#include <cstddef>
#include <cstdint>

#include "skyhalo/stereo/sgm/aggregation.hpp"
#include "skyhalo/stereo/sgm/aligned_buffer.hpp"
#include "skyhalo/stereo/sgm/census.hpp"
#include "skyhalo/stereo/sgm/executor.hpp"
#include "skyhalo/stereo/sgm/layout.hpp"
#include "skyhalo/stereo/sgm/median_fill.hpp"
#include "skyhalo/stereo/sgm/plane.hpp"
#include "skyhalo/stereo/sgm/skew.hpp"
#include "skyhalo/stereo/sgm/speckle.hpp"
#include "skyhalo/stereo/sgm_config.hpp"

namespace skyhalo::sgm {

/// The pixels of one size and search range that an engine is made for.
struct EngineSize {
  int width_px = 0;
  int height_px = 0;
  int max_disparity_px = 0;

  bool operator==(const EngineSize&) const = default;
};

/// Rows of someone else's image, each `stride` values after the one before.
template <class T>
struct ImageRows {
  T* first = nullptr;
  std::ptrdiff_t stride = 0;

  [[nodiscard]] T* row(int v) const noexcept { return first + v * stride; }
};

/// A rectified pair, and which of its images the disparities are aligned with.
struct GreyPair {
  ImageRows<const std::uint8_t> left;
  ImageRows<const std::uint8_t> right;
  bool align_left = false;
};

/// What an engine does, one after the other.
enum class EngineStage : std::uint8_t {
  kSmooth,     ///< smoothed copies, texture
  kCensus,     ///< census transform of both images
  kSkew,       ///< from rows to the order of the sweeps
  kSweeps,     ///< cost, eight paths, winners of both images, sub-pixel, uniqueness
  kLeftRight,  ///< back to rows; repetition, left-right check
  kMedian,     ///< median, holes filled where the image tells enough
  kSpeckles,   ///< small islands dropped
  kEdges,      ///< pixels at depth edges dropped
};

/// Hears when a stage is done, for those who measure.
class EngineListener {
 public:
  EngineListener() = default;
  EngineListener(const EngineListener&) = default;
  EngineListener(EngineListener&&) = default;
  EngineListener& operator=(const EngineListener&) = default;
  EngineListener& operator=(EngineListener&&) = default;
  virtual ~EngineListener() = default;

  virtual void done(EngineStage stage) = 0;
};

/// Semi-Global Matching (Hirschmueller 2008) from grey images to disparities, without OpenCV and
/// without threads of its own. Made for one size; allocates nothing after that. Not for use by two
/// threads at once.
class Engine {
 public:
  /// Settings and size are those that `check` and `SgmMatcher` let through: an image wider than the
  /// range, the range a multiple of 16 in [16, 256].
  Engine(const SgmConfig& config, const EngineSize& size);

  [[nodiscard]] const EngineSize& size() const noexcept { return size_; }

  /// The vectors that the engine was laid out for; it must run with no others.
  [[nodiscard]] int lanes() const noexcept { return layout_.lanes; }

  /// Disparities (px) aligned with the right image (or the left one): right pixel (u, v) matches
  /// left (u + d, v). NaN where there is none. The same bits whatever executor and vectors.
  void match(const GreyPair& pair,
             const ImageRows<float>& disparity_px,
             Executor& executor,
             EngineListener* listener = nullptr);

 private:
  /// One image on its way to the skewed census.
  struct Side {
    CensusImages images;
    CensusImages census;  // the three bytes, in the same places
    AlignedBuffer<std::uint8_t> lane_rows;
    AlignedBuffer<std::uint8_t> steps;
  };

  [[nodiscard]] Side make_side(int steps) const;
  void lay_out_limits();
  void smooth_both(const GreyPair& pair, Executor& executor);
  void take_both_census(Executor& executor);
  void smooth(Side& side, int first, int last) noexcept;
  void take_census(Side& side, int v) noexcept;
  void place_guide(int v) noexcept;
  void skew_side(Side& side, int step) noexcept;
  void skew_all(Executor& executor);
  void sweep(Executor& executor);
  void join_left_winners() noexcept;
  void check_winners(Executor& executor);
  void back_to_rows(Executor& executor);
  void fill_holes(Executor& executor);
  void drop_speckles(Executor& executor);
  void drop_edges(const GreyPair& pair, const ImageRows<float>& disparity_px, Executor& executor);
  [[nodiscard]] Sweep sweep_of(SweepState& state, AlignedBuffer<std::uint8_t>& left) noexcept;
  [[nodiscard]] LaneRows lane_rows_of(AlignedBuffer<std::uint8_t>& planes,
                                      int plane) const noexcept;

  SgmConfig config_;
  EngineSize size_;
  SkewLayout layout_;
  Side left_;
  Side right_;
  Plane<std::uint8_t> guide_;
  Plane<std::uint8_t> textured_;
  Plane<std::uint8_t> repeated_;
  Plane<std::uint8_t> repeated_counts_;
  Plane<std::uint8_t> confident_;
  AlignedBuffer<std::uint8_t> guide_rows_;
  AlignedBuffer<std::uint8_t> guide_steps_;
  AlignedBuffer<std::uint8_t> limit_;
  AlignedBuffer<std::uint8_t> inside_;
  SweepState forward_;
  SweepState backward_;
  AlignedBuffer<std::uint8_t> half_sum_;
  AlignedBuffer<std::uint8_t> winners_;        // disparity, offset and repetition
  AlignedBuffer<std::uint8_t> forward_left_;   // cost and disparity
  AlignedBuffer<std::uint8_t> backward_left_;  // likewise
  AlignedBuffer<std::uint8_t> winner_rows_;    // these and the left disparity
  Plane<std::int16_t> disparity_64_;
  Plane<std::int16_t> filled_64_;
  RowMedians medians_;
  SpeckleFilter speckles_;
  Plane<float> disparity_px_;
};

}  // namespace skyhalo::sgm
