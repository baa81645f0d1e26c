#include "skyhalo/camera/virtual_pair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/camera/monotone.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

constexpr double kStep = rad_from_deg(0.25);
constexpr int kSizeUnit = 16;  // chosen sizes are multiples, so that they halve and vectorise well
constexpr int kLeastSize = 16;
constexpr int kLargestSize = 16384;

/// How far a chosen image may reach to each side, and the widest that can be asked for.
struct FieldLimits {
  double across_rad;
  double upright_rad;
  double widest_deg;
  double tallest_deg;
};

FieldLimits limits_of(PairModelKind model) noexcept {
  return model == PairModelKind::kPinhole
             ? FieldLimits{rad_from_deg(60.0), rad_from_deg(60.0), 150.0, 150.0}
             : FieldLimits{rad_from_deg(87.0), rad_from_deg(80.0), 179.0, 340.0};
}

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorKind::kInput, message);
}

std::string degrees(double angle_rad) {
  const double rounded = std::round(deg_from_rad(angle_rad) * 10.0) / 10.0;
  std::string text = std::to_string(rounded);
  return text.substr(0, text.find('.') + 2) + " degrees";
}

/// The common orientation (Fusiello 2000, with z between the two axes): rotations from `cam`.
struct Orientation {
  Eigen::Matrix3d R_left_cam;
  Eigen::Matrix3d R_right_cam;
  double baseline_m;
};

Orientation orient(const Pose& T_right_left) {
  const Eigen::Vector3d to_left = T_right_left.translation();
  const double baseline_m = to_left.norm();
  if (!(baseline_m > 1e-9) || !std::isfinite(baseline_m)) {
    refuse("T_right_left: the baseline is zero; expected two cameras side by side");
  }
  const Eigen::Vector3d x = -to_left / baseline_m;
  const Eigen::Vector3d left_axis = T_right_left.linear().col(2);
  const Eigen::Vector3d left_rows = T_right_left.linear().col(0);
  if (!(x.x() > 0.5) || !(x.dot(left_rows) > 0.5)) {
    refuse(
        "T_right_left: the left camera does not stand to the left of the right one; left and right "
        "are swapped, or the extrinsics are inverted");
  }
  const Eigen::Vector3d between = left_axis + Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d z = (between - x * x.dot(between)).normalized();
  Eigen::Matrix3d R_right_cam;
  R_right_cam << x, z.cross(x), z;
  if (!R_right_cam.allFinite() || !(left_axis.z() > 0.0)) {
    refuse("T_right_left: the two cameras do not look the same way");
  }
  return {T_right_left.linear().transpose() * R_right_cam, R_right_cam, baseline_m};
}

bool sees(const RawCamera& camera, const Eigen::Vector3d& ray) noexcept {
  const std::optional<Eigen::Vector2d> pixel = project(camera.lens, ray);
  return pixel && pixel->x() >= 0.0 && pixel->y() >= 0.0 &&
         pixel->x() <= camera.size_px.width - 1.0 && pixel->y() <= camera.size_px.height - 1.0;
}

/// The angles from the axis to the four sides, each positive outwards.
struct Extent {
  double left_rad;
  double right_rad;
  double up_rad;
  double down_rad;
};

Extent seen_by_both(const RawPair& raw, const Orientation& turned, const FieldLimits& limits) {
  const auto reach = [&](const Eigen::Vector3d& outwards, double limit_rad) {
    const auto both_see = [&](double angle_rad) {
      const Eigen::Vector3d ray =
          std::cos(angle_rad) * Eigen::Vector3d::UnitZ() + std::sin(angle_rad) * outwards;
      return sees(raw.left, turned.R_left_cam * ray) && sees(raw.right, turned.R_right_cam * ray);
    };
    return holds_until(both_see, kStep, limit_rad);
  };
  const Extent extent{reach(-Eigen::Vector3d::UnitX(), limits.across_rad),
                      reach(Eigen::Vector3d::UnitX(), limits.across_rad),
                      reach(-Eigen::Vector3d::UnitY(), limits.upright_rad),
                      reach(Eigen::Vector3d::UnitY(), limits.upright_rad)};
  if (std::min({extent.left_rad, extent.right_rad, extent.up_rad, extent.down_rad}) < kStep) {
    refuse("T_right_left: the cameras have no field in common around the middle of their axes");
  }
  return extent;
}

/// Raw pixels per radian around the virtual axis, the mean of both cameras: across and upright.
Eigen::Vector2d raw_density_px(const RawPair& raw, const Orientation& turned) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& [camera, R] :
       {std::pair(&raw.left, &turned.R_left_cam), std::pair(&raw.right, &turned.R_right_cam)}) {
    const std::optional<LensJacobian> J = jacobian(camera->lens, R->col(2));
    if (!J) {
      refuse("T_right_left: the common orientation lies outside what the lenses image");
    }
    sum += Eigen::Vector2d((*J * R->col(0)).norm(), (*J * R->col(1)).norm());
  }
  return sum / 2.0;
}

/// One side of the image, in the coordinate that runs evenly over the pixels: the tangent for a
/// pinhole, the angle for a spherical model.
struct Axis {
  double per_px = 0.0;        ///< of the coordinate
  double principal_px = 0.0;  ///< where it is 0
  int size_px = 0;
};

int whole_units(double size_px) {
  return std::max(kLeastSize, static_cast<int>(size_px / kSizeUnit) * kSizeUnit);
}

/// A side that covers [-before, after] of its coordinate; pixels of `per_px` unless a size is
/// given.
Axis cover(double before, double after, double per_px, std::optional<int> size_px) {
  const double span = before + after;
  const int size = size_px.value_or(whole_units(span / per_px + 1e-6));
  const double step = size_px ? span / size : per_px;
  const double middle = 0.5 * (after - before);
  return {step, 0.5 * (size - 1) - middle / step, size};
}

/// A side with an exact field: centred, the pixel made to fit the size.
Axis centred(double half, double per_px, std::optional<int> size_px) {
  const double units = std::round(2.0 * half / per_px / kSizeUnit) * kSizeUnit;
  const int size = size_px.value_or(std::max(kLeastSize, static_cast<int>(units)));
  return {2.0 * half / size, 0.5 * (size - 1), size};
}

void check_angle(const char* key, const std::optional<double>& angle_rad, double widest_deg) {
  if (angle_rad && !(*angle_rad > 0.0 && *angle_rad <= rad_from_deg(widest_deg) + 1e-9)) {
    refuse(std::string(key) + ": this model can show up to " + degrees(rad_from_deg(widest_deg)) +
           ", found " + degrees(*angle_rad));
  }
}

void check_size(const cv::Size& size) {
  if (std::min(size.width, size.height) < kLeastSize ||
      std::max(size.width, size.height) > kLargestSize) {
    refuse("size_px: expected a width and height in 16...16384 pixels");
  }
}

/// A wished field must lie inside both lens models; whether the image sensor reaches as far is for
/// the mask of valid pixels.
void check_inside_lenses(const char* key,
                         double half_rad,
                         const Eigen::Vector3d& outwards,
                         const RawPair& raw,
                         const Orientation& turned) {
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d ray =
        std::cos(half_rad) * Eigen::Vector3d::UnitZ() + side * std::sin(half_rad) * outwards;
    for (const auto& [camera, R] :
         {std::pair(&raw.left, &turned.R_left_cam), std::pair(&raw.right, &turned.R_right_cam)}) {
      if (!project(camera->lens, *R * ray)) {
        refuse(std::string(key) + ": " + degrees(2.0 * half_rad) +
               " reach beyond the lens model, which ends " + degrees(max_angle_rad(camera->lens)) +
               " from its axis");
      }
    }
  }
}

void check_wish(const VirtualPairWish& wish, const RawPair& raw, const Orientation& turned) {
  const FieldLimits limits = limits_of(wish.model);
  check_angle("hfov_deg", wish.hfov_rad, limits.widest_deg);
  check_angle("vfov_deg", wish.vfov_rad, limits.tallest_deg);
  if (wish.size_px) {
    check_size(*wish.size_px);
  }
  if (wish.hfov_rad) {
    check_inside_lenses("hfov_deg", 0.5 * *wish.hfov_rad, Eigen::Vector3d::UnitX(), raw, turned);
  }
  if (wish.vfov_rad) {
    check_inside_lenses("vfov_deg", 0.5 * *wish.vfov_rad, Eigen::Vector3d::UnitY(), raw, turned);
  }
}

std::optional<int> width_of(const std::optional<cv::Size>& size) {
  return size ? std::optional(size->width) : std::nullopt;
}

std::optional<int> height_of(const std::optional<cv::Size>& size) {
  return size ? std::optional(size->height) : std::nullopt;
}

struct Axes {
  Axis across;
  Axis upright;
};

/// Rows and columns of an angular image are independent of each other.
Axes spherical_axes(const VirtualPairWish& wish,
                    const Extent& seen,
                    const Eigen::Vector2d& density) {
  const auto axis = [](const std::optional<double>& field_rad,
                       double before,
                       double after,
                       double per_px,
                       std::optional<int> size_px) {
    return field_rad ? centred(0.5 * *field_rad, per_px, size_px)
                     : cover(before, after, per_px, size_px);
  };
  return {
      axis(wish.hfov_rad, seen.left_rad, seen.right_rad, 1.0 / density.x(), width_of(wish.size_px)),
      axis(wish.vfov_rad, seen.up_rad, seen.down_rad, 1.0 / density.y(), height_of(wish.size_px))};
}

/// A pinhole has one focal length: the first of width, height that is settled decides it.
Axes pinhole_axes(const VirtualPairWish& wish, const Extent& seen, const Eigen::Vector2d& density) {
  const double chosen_px = 1.0 / density.mean();
  const double left = std::tan(seen.left_rad);
  const double right = std::tan(seen.right_rad);
  const double up = std::tan(seen.up_rad);
  const double down = std::tan(seen.down_rad);
  Axes axes;
  if (!wish.hfov_rad && wish.vfov_rad) {
    axes.upright = centred(std::tan(0.5 * *wish.vfov_rad), chosen_px, height_of(wish.size_px));
    axes.across = cover(left, right, axes.upright.per_px, std::nullopt);
    if (wish.size_px) {  // the width is the user's, the pixel is settled
      axes.across.size_px = wish.size_px->width;
      axes.across.principal_px =
          0.5 * (wish.size_px->width - 1) - 0.5 * (right - left) / axes.upright.per_px;
    }
    return axes;
  }
  axes.across = wish.hfov_rad
                    ? centred(std::tan(0.5 * *wish.hfov_rad), chosen_px, width_of(wish.size_px))
                    : cover(left, right, chosen_px, width_of(wish.size_px));
  const double per_px = axes.across.per_px;
  if (wish.vfov_rad) {
    const double height = 2.0 * std::tan(0.5 * *wish.vfov_rad) / per_px;
    const int size = std::max(kLeastSize, static_cast<int>(std::lround(height)));
    if (wish.size_px && std::abs(wish.size_px->height - height) > 1.0) {
      refuse(
          "vfov_deg: does not fit size_px and hfov_deg, as a pinhole's pixels are square; leave "
          "one of the three out");
    }
    const int height_px = wish.size_px ? wish.size_px->height : size;
    axes.upright = {per_px, 0.5 * (height_px - 1), height_px};
  } else {
    axes.upright = cover(up, down, per_px, std::nullopt);
    if (wish.size_px) {
      const double middle = wish.hfov_rad ? 0.0 : 0.5 * (down - up);
      axes.upright = {
          per_px, 0.5 * (wish.size_px->height - 1) - middle / per_px, wish.size_px->height};
    }
  }
  return axes;
}

PairModel model_of(PairModelKind kind, const Axes& axes, double baseline_m) {
  if (kind == PairModelKind::kPinhole) {
    return PinholePair{.focal_px = 1.0 / axes.across.per_px,
                       .principal_u_px = axes.across.principal_px,
                       .principal_v_px = axes.upright.principal_px,
                       .baseline_m = baseline_m};
  }
  return SphericalPair{.delta_theta_u_rad = axes.across.per_px,
                       .delta_theta_v_rad = axes.upright.per_px,
                       .principal_u_px = axes.across.principal_px,
                       .principal_v_px = axes.upright.principal_px,
                       .baseline_m = baseline_m};
}

double field_rad(const PinholePair& pair, double principal_px, int size_px) noexcept {
  return std::atan((size_px - 0.5 - principal_px) / pair.focal_px) +
         std::atan((principal_px + 0.5) / pair.focal_px);
}

}  // namespace

VirtualPair make_virtual_pair(const RawPair& raw, const VirtualPairWish& wish) {
  const Orientation turned = orient(raw.T_right_left);
  check_wish(wish, raw, turned);
  const Extent seen = seen_by_both(raw, turned, limits_of(wish.model));
  const Eigen::Vector2d density = raw_density_px(raw, turned);
  const Axes axes = wish.model == PairModelKind::kPinhole ? pinhole_axes(wish, seen, density)
                                                          : spherical_axes(wish, seen, density);
  const cv::Size size(axes.across.size_px, axes.upright.size_px);
  check_size(size);
  return {
      size, model_of(wish.model, axes, turned.baseline_m), turned.R_left_cam, turned.R_right_cam};
}

FieldOfView field_of_view(const PairModel& pair, const cv::Size& size_px) noexcept {
  if (const auto* pinhole = std::get_if<PinholePair>(&pair)) {
    return {field_rad(*pinhole, pinhole->principal_u_px, size_px.width),
            field_rad(*pinhole, pinhole->principal_v_px, size_px.height)};
  }
  const auto& spherical = *std::get_if<SphericalPair>(&pair);
  return {size_px.width * spherical.delta_theta_u_rad,
          size_px.height * spherical.delta_theta_v_rad};
}

}  // namespace skyhalo
