#include "skyhalo/sim/scene.hpp"

#include <algorithm>
#include <cmath>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

[[nodiscard]] Error fault(const std::string& what) {
  return {ErrorKind::kInput, what};
}

void check_texture(int texture, const Scene& scene, const std::string& whose) {
  if (texture >= static_cast<int>(scene.textures.size())) {
    throw fault(whose + ": there is no texture " + std::to_string(texture));
  }
}

bool is_share(float value) {
  return value >= 0.0F && value <= 1.0F;  // false for NaN
}

void check_material(const Material& material, const Scene& scene, const std::string& whose) {
  check_texture(material.texture, scene, whose);
  if (!material.colour_bgr.allFinite() || material.colour_bgr.minCoeff() < 0.0F) {
    throw fault(whose + ": a colour must be finite and not negative");
  }
  if (!(material.texture_edge_m > 0.0F) || !std::isfinite(material.texture_edge_m)) {
    throw fault(whose + ": texture_edge_m must be greater than 0");
  }
  if (!is_share(material.variation) || !is_share(material.mirror) ||
      !is_share(material.laser_reflectivity)) {
    throw fault(whose + ": variation, mirror and laser_reflectivity must be in 0...1");
  }
}

void check_mesh(const TriangleMesh& mesh, const Scene& scene, const std::string& whose) {
  check(mesh, whose);
  const auto highest = std::max_element(mesh.materials.begin(), mesh.materials.end());
  if (*highest >= scene.materials.size()) {
    throw fault(whose + ": there is no material " + std::to_string(*highest));
  }
}

/// How long a route is (m); NaN or infinite for points that are.
double length_m(const Route& route) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < route.points_m.size(); ++i) {
    length_m += (route.points_m[i] - route.points_m[i - 1]).norm();
  }
  return length_m;
}

void check_mover(const MovingObject& mover, const Scene& scene, const std::string& whose) {
  check_mesh(mover.mesh, scene, whose);
  const Route& route = mover.route;
  const double length = length_m(route);
  if (!(length > 0.0) || !std::isfinite(length)) {
    throw fault(whose + ": its route needs two different points, all finite");
  }
  if (!(route.speed_mps >= 0.0) || !std::isfinite(route.speed_mps) ||
      !std::isfinite(route.start_m)) {
    throw fault(whose + ": its speed must be finite and not negative, its start finite");
  }
  if (!(mover.size_m.minCoeff() > 0.0) || !mover.size_m.allFinite()) {
    throw fault(whose + ": its size must be greater than 0");
  }
}

}  // namespace

void check(const Scene& scene) {
  const std::string prefix = "scene \"" + scene.name + "\": ";
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    check_material(
        scene.materials[i],
        scene,
        prefix + "material " + std::to_string(i) + " \"" + scene.materials[i].name + "\"");
  }
  check_texture(scene.lighting.cloud_texture, scene, prefix + "clouds");
  check_mesh(scene.fixed, scene, prefix + "what stands");
  for (const MovingObject& mover : scene.movers) {
    check_mover(
        mover, scene, prefix + "mover " + std::to_string(mover.track) + " (" + mover.type + ")");
  }
}

}  // namespace skyhalo
