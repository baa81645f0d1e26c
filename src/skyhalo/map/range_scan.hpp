#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace skyhalo {

/// Values that scans have in memory behind their last direction, for vectors that read past it.
inline constexpr std::size_t kScanPadding = 64;

/// What the range sensors of one moment say of all directions round the body: per direction the
/// range of the nearest thing with its uncertainty, or else how far it was seen free, or nothing.
/// Row r covers polar angles from `r * step` (0 is up), column c azimuths from `-pi + c * step` (0
/// is forward, positive left), in the body's frame.
class RangeScan {
 public:
  /// All directions unseen; `2 * rows` columns. Throws `Error` (input) unless rows is 2 to 2000.
  explicit RangeScan(int rows);

  [[nodiscard]] int rows() const noexcept { return rows_; }

  [[nodiscard]] int cols() const noexcept { return 2 * rows_; }

  [[nodiscard]] double step_rad() const noexcept;

  /// Unit vector (body) through the middle of a direction.
  [[nodiscard]] Eigen::Vector3d direction(int row, int col) const noexcept;

  /// All directions unseen again.
  void clear() noexcept;

  /// There is a thing at this range (m), which is uncertain by `delta_z_m`: kept within 0.1 mm and
  /// 10 km. A range that is not above 0 or not finite, and an uncertainty of NaN, leave the
  /// direction unseen.
  void set_depth(int row, int col, float z_m, float delta_z_m) noexcept;

  /// Seen, and nothing up to this range (m); one that is not above 0 or not finite: unseen.
  void set_free(int row, int col, float free_to_m) noexcept;

  /// The greatest range of a thing that was set since all was unseen (m); 0 for none.
  [[nodiscard]] double farthest_m() const noexcept { return farthest_m_; }

  /// Of all directions, row-major: ranges (NaN for none), their uncertainties (where there is a
  /// range), and how far directions without a range were seen free (0 for unseen).
  [[nodiscard]] std::span<const float> z_m() const noexcept { return directions(z_m_); }

  [[nodiscard]] std::span<const float> delta_z_m() const noexcept { return directions(delta_z_m_); }

  [[nodiscard]] std::span<const float> free_to_m() const noexcept { return directions(free_to_m_); }

 private:
  [[nodiscard]] static std::span<const float> directions(
      const std::vector<float>& values) noexcept {
    return std::span(values).first(values.size() - kScanPadding);
  }

  [[nodiscard]] std::size_t index_of(int row, int col) const noexcept {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols()) +
           static_cast<std::size_t>(col);
  }

  int rows_;
  std::vector<float> z_m_;
  std::vector<float> delta_z_m_;
  std::vector<float> free_to_m_;
  double farthest_m_ = 0.0;
};

}  // namespace skyhalo
