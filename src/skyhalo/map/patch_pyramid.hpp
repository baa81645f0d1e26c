#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "skyhalo/map/scan_patches.hpp"

namespace skyhalo {

/// How a cube of space is decided by a scan as a whole.
enum class CubeVerdict : std::uint8_t {
  kNothing,  ///< nothing is said of any place in it
  kCrossed,  ///< all of it is merely crossed
  kMixed,    ///< it must be looked at more closely
};

/// Cubes whose verdict is asked for at once: as many as there are eighths of
/// eight bricks.
inline constexpr std::size_t kCubesAtOnce = 64;

/// Cubes of one size, along the map's axes, by their centres from the body's
/// origin, in the body's frame (m). Places behind the last one are zero: vectors hold them, too,
/// and what else lay there might be NaN.
struct Cubes {  // NOLINT(*-member-init): `known` is asked for as many as are counted
  alignas(64) std::array<float, kCubesAtOnce> x_m{};
  alignas(64) std::array<float, kCubesAtOnce> y_m{};
  alignas(64) std::array<float, kCubesAtOnce> z_m{};
  std::array<bool, kCubesAtOnce> known;  ///< to be mixed, without being asked for
  float half_edge_m = 0.0F;
  std::size_t count = 0;

  /// At most `kCubesAtOnce`.
  void add(const Eigen::Vector3f& center_m, bool known_mixed) noexcept {
    known[count] = known_mixed;
    x_m[count] = center_m.x();
    y_m[count] = center_m.y();
    z_m[count] = center_m.z();
    ++count;
  }
};

/// The directions that cubes may lie in, by the balls that hold them; columns may go on before the
/// first one or behind the last.
struct Windows {  // NOLINT(*-member-init): as many as there are cubes
  alignas(64) std::array<std::int32_t, kCubesAtOnce> first_row;
  alignas(64) std::array<std::int32_t, kCubesAtOnce> last_row;
  alignas(64) std::array<std::int32_t, kCubesAtOnce> first_col;
  alignas(64) std::array<std::int32_t, kCubesAtOnce> last_col;

  /// Whether a cube's directions are of at most so many rows and columns, none of them beyond the
  /// scan's `cols`.
  [[nodiscard]] bool fits(std::size_t cube, int most, int cols) const noexcept {
    return last_row[cube] - first_row[cube] < most && last_col[cube] - first_col[cube] < most &&
           first_col[cube] >= 0 && last_col[cube] < cols;
  }
};

/// What a scan says of cubes.
struct Verdicts {
  Windows windows;
  alignas(64) std::array<float, kCubesAtOnce> theta_rad;  ///< direction of the middle: polar angle
  alignas(64) std::array<float, kCubesAtOnce> phi_rad;    ///< azimuth from straight behind, >= 0
  std::array<std::uint8_t, kCubesAtOnce> narrow;  ///< not 0: all of the cube is within `kNarrowRad`
                                                  ///< of both, off the poles and the half-plane
                                                  ///< behind
  std::array<CubeVerdict, kCubesAtOnce> verdict;
};

inline constexpr float kNarrowRad = 0.2F;

/// A cube is judged by at most so many nodes along each axis: of the finest level where they
/// suffice.
inline constexpr int kNodesAcross = 6;

/// What windows of directions have in common, one array per number.
struct PatchNodes {
  std::vector<float> near_m;   ///< the least of their patches'
  std::vector<float> far_m;    ///< the greatest
  std::vector<float> x_per_m;  ///< a plane near their patches: 1/range is the product of this
  std::vector<float> y_per_m;  ///< vector and a direction; NaN when one has no depth
  std::vector<float> z_per_m;
  std::vector<float> size_per_m;  ///< sum of the vector's components along the map's axes, unsigned
  std::vector<float> bend_per_m;  ///< how far 1/range of a patch is from the plane's at most
  std::vector<float> before;      ///< a place is merely crossed when range/(a
                                  ///< patch's range) is at most 1 less this
  std::vector<float> behind;      ///< nothing is said of it when that is at least 1 plus this

  [[nodiscard]] std::array<std::vector<float>*, 9> all() noexcept {
    return {
        &near_m, &far_m, &x_per_m, &y_per_m, &z_per_m, &size_per_m, &bend_per_m, &before, &behind};
  }
};

/// A row of a scan's directions, on its way into the finest nodes; the angles are of its middle.
struct DirectionRow {
  std::size_t first = 0;  ///< place of its first direction
  std::size_t to = 0;     ///< and of the node for that
  float sin_theta = 0.0F;
  float cos_theta = 0.0F;
  float rows_per_rad = 0.0F;
};

/// A row of nodes, on its way into coarser ones.
struct NodeRow {
  std::size_t first = 0;         ///< place of its first node
  std::size_t first_column = 0;  ///< of its level, in what is known of columns
  float sin_theta = 0.0F;
  float cos_theta = 0.0F;
  float extent_rad = 0.0F;  ///< how far a node's directions are from its middle at most
};

/// What a scan's patches have in common over windows of directions: per level,
/// directions are put together by two and two (Williams 1983, mip maps).
class PatchPyramid {
 public:
  /// Allocates when the scan has another size than the last one.
  void build(const ScanPatches& patches, const CellFrame& frame);

  /// What the scan decides of each cube; never wrong but for calling one mixed
  /// that is not. Vectors of the best instruction set.
  void judge(const Cubes& cubes, Verdicts& verdicts) const noexcept;

  /// The greatest `far_m` of all directions: nothing is said of what is
  /// farther.
  [[nodiscard]] float reach_m() const noexcept { return reach_m_; }

  static constexpr int kMostLevels = 16;

  /// A level's nodes, row by row: `stride` from one row to the next, which is
  /// even.
  struct Level {
    int rows = 0;
    int columns = 0;
    std::int32_t first_column = 0;  ///< in what is known of columns
    std::int32_t first_row = 0;     ///< and of rows
    double step_rad = 0.0;          ///< edge of a node
  };

  int rows = 0;
  int cols = 0;
  int levels = 0;
  Eigen::Matrix3f R_map_body = Eigen::Matrix3f::Identity();
  std::array<Level, kMostLevels> shape{};
  std::array<std::int32_t, kMostLevels> first{};  ///< where a level's nodes begin
  std::array<std::int32_t, kMostLevels> stride{};
  PatchNodes nodes;            ///< level by level
  std::vector<float> sin_phi;  ///< of the middles of a level's columns
  std::vector<float> cos_phi;
  std::vector<float> sin_theta;  ///< of the middles of a level's rows
  std::vector<float> cos_theta;

 private:
  void resize(const ScanPatches& patches);
  void find_middles(const Level& level);
  [[nodiscard]] std::size_t row_of(int level, int row) const noexcept;
  void gather(int level, int row);
  void close_row(int level, int row);

  float reach_m_ = 0.0F;
};

}  // namespace skyhalo
