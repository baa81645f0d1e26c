#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// Makes the error (input) about one place of a file: `FILE:LINE: key: message`. Internal to this
/// layer, as all of this header.
using ErrorAt = std::function<Error(std::string_view message)>;

/// The rotation nearest to R (least squares of the entries).
[[nodiscard]] Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& R);

/// The rotation that a file gives: as it is where R R' is at most 1e-5 off the identity, as printed
/// digits leave it; else the nearest one, with a warning. Throws `error_at` when it is more than
/// 1e-3 off or R is a mirror image.
[[nodiscard]] Eigen::Matrix3d rotation_from(const Eigen::Matrix3d& R,
                                            const ErrorAt& error_at,
                                            std::vector<std::string>& warnings);

/// The same of 9 numbers, row by row; throws for any other count.
[[nodiscard]] Eigen::Matrix3d rotation_from(std::span<const double> numbers,
                                            const ErrorAt& error_at,
                                            std::vector<std::string>& warnings);

/// The rigid transform of the 16 numbers of a 4x4 matrix, row by row (m). Throws and warns as
/// `rotation_from`, and throws for any other count and when the last row is not 0 0 0 1.
[[nodiscard]] Pose pose_from(std::span<const double> numbers,
                             const ErrorAt& error_at,
                             std::vector<std::string>& warnings);

/// The rotation of a quaternion that a file gives. Throws and warns about its norm as
/// `rotation_from` does about R.
[[nodiscard]] Eigen::Matrix3d rotation_from(const Eigen::Quaterniond& q,
                                            const ErrorAt& error_at,
                                            std::vector<std::string>& warnings);

}  // namespace skyhalo
