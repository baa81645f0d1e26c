#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "skyhalo/base/timestamp.hpp"
#include "skyhalo/sphere/spherical_grid.hpp"

namespace skyhalo {

/// What is known of a direction, or of several.
enum class Sight : std::uint8_t {
  kUnseen,    ///< no pixel looked there, or too few could tell anything: not free
  kFree,      ///< seen, and nothing near up to a stated range
  kObstacle,  ///< something at a known range
};

/// One pair's grid of the moment; `grid` is null when the pair did not deliver.
struct PairGrid {
  const SphericalGrid* grid = nullptr;
  Timestamp stamp;  ///< when its images were taken
};

/// The nearest distances in all directions round the body, of all pairs together (thesis 5.4): the
/// whole sphere, row-major, columns from straight backwards over the right side, ahead and the left
/// side. Ranges are in metres from the body origin.
class Halo {
 public:
  /// Nothing seen yet. Throws `Error` (input) unless the step divides a half turn.
  explicit Halo(double step_rad);

  [[nodiscard]] const GridGeometry& geometry() const noexcept { return geometry_; }

  [[nodiscard]] Sight sight(GridCell cell) const noexcept;

  /// Range of the nearest thing in a cell's direction; none where nothing is known of one.
  [[nodiscard]] std::optional<double> depth_m(GridCell cell) const noexcept;

  /// The range up to which a cell was seen to be free, at most its depth; 0 where unseen.
  [[nodiscard]] double free_to_m(GridCell cell) const noexcept;

  /// Which pair the cell's depth, or else its freedom, comes from, by its place in the rig; none
  /// where unseen.
  [[nodiscard]] std::optional<std::size_t> source(GridCell cell) const noexcept;

  /// How old the images are in which this cell was last seen; none if it never was. A cell that is
  /// unseen now still says since when: nothing else of what was seen remains.
  [[nodiscard]] std::optional<double> age_s(GridCell cell, Timestamp now) const noexcept;

  /// The same for all cells, row-major: NaN for no depth, 0 for unseen, `kNoSource` for none.
  [[nodiscard]] std::span<const float> depths_m() const noexcept { return depths_m_; }

  [[nodiscard]] std::span<const float> free_to_m() const noexcept { return free_to_m_; }

  [[nodiscard]] std::span<const std::uint8_t> sources() const noexcept { return sources_; }

  /// Unit vectors (body) through the middle of all cells, row-major.
  [[nodiscard]] std::span<const Eigen::Vector3f> directions() const noexcept { return directions_; }

  static constexpr std::uint8_t kNoSource = 255;

  /// Says of one cell what another sensor, or a test, knows: the range of the nearest thing (NaN
  /// for none) and how far it is free, at most that far; neither below 0.
  void set(GridCell cell,
           float depth_m,
           float free_to_m,
           std::uint8_t source = 0,
           Timestamp stamp = {}) noexcept;

  /// Replaces what the halo says by an overlay of grids whose steps are the halo's (thesis 5.4):
  /// where several have a depth the nearest wins, the first of equals. A cell is free as far as the
  /// pair that saw farthest found it so, at most to its depth. What no pair delivers is unseen.
  /// Throws `Error` (input) for another step or more than 255 grids. Does not allocate.
  void stitch(std::span<const PairGrid> grids);

 private:
  void overlay(const PairGrid& pair, std::uint8_t source) noexcept;

  [[nodiscard]] std::size_t index_of(GridCell cell) const noexcept {
    return static_cast<std::size_t>(geometry_.offset_of(cell));
  }

  GridGeometry geometry_;
  std::vector<float> depths_m_;
  std::vector<float> free_to_m_;
  std::vector<std::uint8_t> sources_;
  std::vector<std::int64_t> seen_ns_;  // stamp of the images in which a cell was last seen
  std::vector<Eigen::Vector3f> directions_;
};

}  // namespace skyhalo
