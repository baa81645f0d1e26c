#include "skyhalo/dataset/kitti_label_text.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "skyhalo/base/number_text.hpp"

namespace skyhalo {
namespace {

constexpr double kNearestM = 0.1;

/// The box's corner whose bits say which of the three edges lead to it.
Eigen::Vector3d corner_of(const OrientedBox& box, unsigned corner) {
  const Eigen::Vector3d along(corner & 1U, (corner >> 1U) & 1U, (corner >> 2U) & 1U);
  return box.corner_m + box.edges_m * along;
}

/// The pixels around what is seen of a box.
struct Outline {
  Eigen::AlignedBox2d box_px;
  bool cut = false;  ///< part of the box was too near or behind
};

void add_pixel(const LabelCamera& camera, const Eigen::Vector3d& p_m, Outline& outline) {
  const double px_per_m = camera.focal_px / p_m.z();
  outline.box_px.extend(Eigen::Vector2d(camera.principal_u_px + px_per_m * p_m.x(),
                                        camera.principal_v_px + px_per_m * p_m.y()));
}

/// Adds an edge of the box from where it comes to lie before the camera.
void add_edge(const LabelCamera& camera,
              const Eigen::Vector3d& from_m,
              const Eigen::Vector3d& to_m,
              Outline& outline) {
  const double from_above = from_m.z() - kNearestM;
  const double to_above = to_m.z() - kNearestM;
  if (from_above >= 0.0) {
    add_pixel(camera, from_m, outline);
  }
  if (to_above >= 0.0) {
    add_pixel(camera, to_m, outline);
  }
  if ((from_above < 0.0) != (to_above < 0.0)) {
    add_pixel(camera, from_m + (to_m - from_m) * (from_above / (from_above - to_above)), outline);
  }
  outline.cut = outline.cut || from_above < 0.0 || to_above < 0.0;
}

Outline outline_of(const OrientedBox& box, const LabelCamera& camera) {
  Outline outline;
  for (unsigned corner = 0; corner < 8; ++corner) {
    for (unsigned edge = 1; edge < 8; edge *= 2) {
      if ((corner & edge) == 0) {
        add_edge(camera, corner_of(box, corner), corner_of(box, corner | edge), outline);
      }
    }
  }
  return outline;
}

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * std::numbers::pi);
}

}  // namespace

LabelBox label_box(const SceneObject& object, const Pose& T_camera_object) {
  // Turned by ry about y, x points to (cos ry, 0, -sin ry).
  const Eigen::Vector3d ahead = T_camera_object.linear().col(0);
  const double rotation_y_rad = std::atan2(-ahead.z(), ahead.x());
  const Eigen::Matrix3d R_box_camera =
      Eigen::AngleAxisd(-rotation_y_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const OrientedBox box = box_of(object, T_camera_object);
  Eigen::AlignedBox3d upright;  // x along the length, y down, z along the width
  for (unsigned corner = 0; corner < 8; ++corner) {
    upright.extend(Eigen::Vector3d(R_box_camera * corner_of(box, corner)));
  }
  const Eigen::Vector3d size_m = upright.sizes();
  const Eigen::Vector3d middle_m = upright.center();
  return {.height_m = size_m.y(),
          .width_m = size_m.z(),
          .length_m = size_m.x(),
          .bottom_center_m = R_box_camera.transpose() *
                             Eigen::Vector3d(middle_m.x(), upright.max().y(), middle_m.z()),
          .rotation_y_rad = rotation_y_rad};
}

std::optional<LabelRegion> label_region(const LabelBox& box, const LabelCamera& camera) {
  const Outline outline = outline_of(to_oriented_box(box), camera);
  const Eigen::AlignedBox2d image(
      Eigen::Vector2d::Zero(),
      Eigen::Vector2d(camera.size_px.width - 1.0, camera.size_px.height - 1.0));
  const Eigen::AlignedBox2d seen = image.intersection(outline.box_px);
  if (outline.box_px.isEmpty() || seen.isEmpty() || !(seen.volume() > 0.0)) {
    return std::nullopt;
  }
  const double share = seen.volume() / outline.box_px.volume();
  const int truncated = outline.cut || share < 0.5 ? 2 : (share < 1.0 ? 1 : 0);
  return LabelRegion{seen, truncated};
}

std::optional<std::string> label_line(const SceneObject& object,
                                      int frame,
                                      const Pose& T_camera_object,
                                      const LabelCamera& camera) {
  const LabelBox box = label_box(object, T_camera_object);
  const std::optional<LabelRegion> region = label_region(box, camera);
  if (!region) {
    return std::nullopt;
  }
  const Eigen::Vector3d& p_m = box.bottom_center_m;
  const double alpha_rad = wrapped(box.rotation_y_rad - std::atan2(p_m.x(), p_m.z()));
  std::string line = std::to_string(frame) + " " + std::to_string(object.track) + " " +
                     object.type + " " + std::to_string(region->truncated) + " " +
                     std::to_string(object.occluded);
  for (const double value : {alpha_rad,
                             region->box_px.min().x(),
                             region->box_px.min().y(),
                             region->box_px.max().x(),
                             region->box_px.max().y(),
                             box.height_m,
                             box.width_m,
                             box.length_m,
                             p_m.x(),
                             p_m.y(),
                             p_m.z(),
                             box.rotation_y_rad}) {
    line += " " + number_text("%.6f", value);
  }
  return line + "\n";
}

}  // namespace skyhalo
