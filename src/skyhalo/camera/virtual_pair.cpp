#include "skyhalo/camera/virtual_pair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/camera/common_orientation.hpp"
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
  return number_text("%.4g degrees", deg_from_rad(angle_rad));
}

/// How far an image reaches to both sides of the optical axis along one direction.
struct Reach {
  double before;  ///< against the direction, positive
  double after;   ///< along it
};

/// The angles (rad) to which both raw cameras see along +-`outwards`.
Reach seen_by_both(const RawPair& raw,
                   const CommonOrientation& turned,
                   const Eigen::Vector3d& outwards,
                   double limit_rad) {
  const auto reach = [&](const Eigen::Vector3d& way) {
    const auto both_see = [&](double angle_rad) {
      const Eigen::Vector3d ray =
          std::cos(angle_rad) * Eigen::Vector3d::UnitZ() + std::sin(angle_rad) * way;
      return sees(raw.left, turned.R_left_cam * ray) && sees(raw.right, turned.R_right_cam * ray);
    };
    return holds_until(both_see, kStep, limit_rad);
  };
  const Reach seen{reach(-outwards), reach(outwards)};
  if (std::min(seen.before, seen.after) < kStep) {
    refuse(
        "T_right_left: the cameras have no field in common around the middle of their axes (or "
        "intrinsics_px leave none)");
  }
  return seen;
}

/// Raw pixels per radian around the virtual axis, the mean of both cameras: across and upright.
Eigen::Vector2d raw_density_px(const RawPair& raw, const CommonOrientation& turned) {
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
  const double bounded_px = std::clamp<double>(size_px, kLeastSize, kLargestSize + kSizeUnit);
  return static_cast<int>(bounded_px / kSizeUnit) * kSizeUnit;
}

/// A side over `reach`; the pixel is `per_px` where no size is given, else made to fit.
Axis cover(const Reach& reach, double per_px, std::optional<int> size_px) {
  const double span = reach.before + reach.after;
  const int size = size_px.value_or(whole_units(span / per_px + 1e-6));
  const double step = size_px ? span / size : per_px;
  return {step, 0.5 * (size - 1) - 0.5 * (reach.after - reach.before) / step, size};
}

/// A side around the middle of `reach` whose pixel is settled; as long as the reach where no size
/// is given.
Axis extend(const Reach& reach, double per_px, std::optional<int> size_px) {
  Axis axis = cover(reach, per_px, std::nullopt);
  if (size_px) {
    axis.principal_px += 0.5 * (*size_px - axis.size_px);
    axis.size_px = *size_px;
  }
  return axis;
}

/// A side with an exact field: centred, the pixel made to fit the size.
Axis centred(double half, double per_px, std::optional<int> size_px) {
  const int size = size_px.value_or(whole_units(2.0 * half / per_px + 0.5 * kSizeUnit));
  return {2.0 * half / size, 0.5 * (size - 1), size};
}

void check_angle(const char* key, const std::optional<double>& angle_rad, double widest_deg) {
  constexpr double kNarrowest = rad_from_deg(1.0);
  if (angle_rad &&
      !(*angle_rad >= kNarrowest - 1e-9 && *angle_rad <= rad_from_deg(widest_deg) + 1e-9)) {
    refuse(std::string(key) + ": this model can show 1 to " + degrees(rad_from_deg(widest_deg)) +
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
                         const CommonOrientation& turned) {
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

void check_wish(const VirtualPairWish& wish, const RawPair& raw, const CommonOrientation& turned) {
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

/// Everything that the sides of an image are chosen by.
struct Choice {
  const VirtualPairWish& wish;
  const RawPair& raw;
  const CommonOrientation& turned;
  FieldLimits limits;
  Eigen::Vector2d density_px;  ///< raw pixels per radian, across and upright

  [[nodiscard]] Reach seen_across() const {
    return seen_by_both(raw, turned, Eigen::Vector3d::UnitX(), limits.across_rad);
  }

  [[nodiscard]] Reach seen_upright() const {
    return seen_by_both(raw, turned, Eigen::Vector3d::UnitY(), limits.upright_rad);
  }
};

Reach tangents(const Reach& angles) noexcept {
  return {std::tan(angles.before), std::tan(angles.after)};
}

/// Rows and columns of an angular image are independent of each other.
Axes spherical_axes(const Choice& choice) {
  const VirtualPairWish& wish = choice.wish;
  const double across_rad = 1.0 / choice.density_px.x();
  const double upright_rad = 1.0 / choice.density_px.y();
  return {wish.hfov_rad ? centred(0.5 * *wish.hfov_rad, across_rad, width_of(wish.size_px))
                        : cover(choice.seen_across(), across_rad, width_of(wish.size_px)),
          wish.vfov_rad ? centred(0.5 * *wish.vfov_rad, upright_rad, height_of(wish.size_px))
                        : cover(choice.seen_upright(), upright_rad, height_of(wish.size_px))};
}

/// The upright side of a pinhole whose pixel the width has settled.
Axis upright_of_pinhole(const Choice& choice, double per_px) {
  const VirtualPairWish& wish = choice.wish;
  const std::optional<int> height_px = height_of(wish.size_px);
  if (wish.vfov_rad) {
    const double half = std::tan(0.5 * *wish.vfov_rad);
    const double fitting_px = 2.0 * half / per_px;
    if (height_px && std::abs(*height_px - fitting_px) > 1.0) {
      refuse(
          "vfov_deg: does not fit size_px and hfov_deg, as a pinhole's pixels are square; leave "
          "one "
          "of the three out");
    }
    const int rounded_px = static_cast<int>(
        std::lround(std::clamp<double>(fitting_px, kLeastSize, kLargestSize + kSizeUnit)));
    return extend({half, half}, per_px, height_px.value_or(rounded_px));
  }
  if (wish.hfov_rad && height_px) {
    return extend({0.0, 0.0}, per_px, height_px);
  }
  return extend(tangents(choice.seen_upright()), per_px, height_px);
}

/// A pinhole has one focal length: of its width and height, a wished field settles it.
Axes pinhole_axes(const Choice& choice) {
  const VirtualPairWish& wish = choice.wish;
  const double chosen = 1.0 / choice.density_px.mean();
  if (wish.vfov_rad && !wish.hfov_rad) {
    const Axis upright = centred(std::tan(0.5 * *wish.vfov_rad), chosen, height_of(wish.size_px));
    return {extend(tangents(choice.seen_across()), upright.per_px, width_of(wish.size_px)),
            upright};
  }
  const Axis across = wish.hfov_rad
                          ? centred(std::tan(0.5 * *wish.hfov_rad), chosen, width_of(wish.size_px))
                          : cover(tangents(choice.seen_across()), chosen, width_of(wish.size_px));
  return {across, upright_of_pinhole(choice, across.per_px)};
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
  const CommonOrientation turned = common_orientation(raw.T_right_left);
  check_wish(wish, raw, turned);
  const Choice choice{wish, raw, turned, limits_of(wish.model), raw_density_px(raw, turned)};
  const Axes axes =
      wish.model == PairModelKind::kPinhole ? pinhole_axes(choice) : spherical_axes(choice);
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
