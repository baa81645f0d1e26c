#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "skyhalo/dataset/laser_source.hpp"
#include "skyhalo/sphere/halo.hpp"

namespace skyhalo::app {

/// What of a frame is compared: things ahead that stand out of the road.
struct LaserCheck {
  double half_angle_rad = 0.0;  ///< of the cone about the body's x axis
  double clearance_m = 0.2;     ///< lower things are road
  double max_range_m = 33.0;    ///< of laser points, from the camera

  /// A thing is borne out when so many laser points of it, itself included, lie within so far.
  int support_count = 3;
  double support_radius_m = 0.5;
};

/// The road in the body frame: points with `up_body . p + below_m = 0`.
struct RoadPlane {
  Eigen::Vector3d up_body = Eigen::Vector3d::UnitZ();  ///< unit vector
  double below_m = 0.0;                                ///< how far the body origin is above it

  [[nodiscard]] double height_m(const Eigen::Vector3d& p_body_m) const noexcept {
    return up_body.dot(p_body_m) + below_m;
  }
};

/// What the laser says of a frame.
struct LaserView {
  RoadPlane road;
  std::optional<double> nearest_m;    ///< range of the nearest thing from the body origin
  std::optional<double> supported_m;  ///< of the nearest that is borne out
  std::vector<Eigen::Vector3d> points_body_m = {};  ///< all of them
};

/// The points (m, body frame) of a scan that the truth camera sees within `max_range_m`.
[[nodiscard]] std::vector<Eigen::Vector3d> seen_points(const LaserScan& scan,
                                                       const LaserSource& source,
                                                       double max_range_m);

/// The plane that most points ahead of and below the body lie within 8 cm of, tilted by 11 degrees
/// at most; none when there are fewer than 50 of them. The same points give the same plane.
[[nodiscard]] std::optional<RoadPlane> road_plane(std::span<const Eigen::Vector3d> points_body_m);

/// None where the scan shows no road.
[[nodiscard]] std::optional<LaserView> view_of_laser(std::span<const Eigen::Vector3d> points_body_m,
                                                     const LaserCheck& check);

/// Range of the nearest thing in the halo among the cells whose middle lies in the cone and whose
/// lower edge, at that range, is out of the road.
[[nodiscard]] std::optional<double> stereo_nearest_m(const Halo& halo,
                                                     const RoadPlane& road,
                                                     const LaserCheck& check);

/// Cells that the halo calls free to some range, and how many of them the laser contradicts.
struct FreeClaims {
  int cells = 0;
  int contradicted = 0;
};

/// Of the cells that are seen and hold at least `support_count` laser points (m, body frame), those
/// with as many points nearer than the range to which they are free, by more than 0.5 m and a tenth
/// of the point's range.
[[nodiscard]] FreeClaims free_claims(const Halo& halo,
                                     std::span<const Eigen::Vector3d> points_body_m,
                                     const LaserCheck& check);

/// Whether the halo's nearest is within 0.5 m or a tenth of the laser's. Where the laser has none,
/// the halo must have none within nine tenths of the maximum range.
[[nodiscard]] bool agrees(const std::optional<double>& laser_m,
                          const std::optional<double>& stereo_m,
                          double max_range_m) noexcept;

/// The words for `agrees`.
inline constexpr const char* kAgreementBound =
    "|stereo - laser| <= max(0.5 m, 10 % of laser); without a laser thing, no stereo thing within "
    "90 % of the maximum range";

}  // namespace skyhalo::app
