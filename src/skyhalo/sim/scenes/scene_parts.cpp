#include "skyhalo/sim/scenes/scene_parts.hpp"

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {
namespace {

std::uint16_t add_material(Scene& scene, const Material& material) {
  scene.materials.push_back(material);
  return static_cast<std::uint16_t>(scene.materials.size() - 1);
}

cv::Vec3b as_bytes(const cv::Scalar& colour) {
  return {cv::saturate_cast<std::uint8_t>(colour[0]),
          cv::saturate_cast<std::uint8_t>(colour[1]),
          cv::saturate_cast<std::uint8_t>(colour[2])};
}

}  // namespace

std::uint16_t add_surface(Scene& scene, const Surface& surface, std::uint64_t seed) {
  return add_faded(scene, surface, 0.0F, seed);
}

std::uint16_t add_faded(Scene& scene, const Surface& surface, float fade, std::uint64_t seed) {
  cv::Mat3b picture = procedural_texture(surface.pattern, stirred(seed, scene.textures.size()));
  if (fade > 0.0F) {
    const cv::Mat3b uniform(picture.size(), as_bytes(cv::mean(picture)));
    const double share = static_cast<double>(fade);
    cv::addWeighted(uniform, share, picture, 1.0 - share, 0.0, picture);
  }
  scene.textures.emplace_back(picture);
  Material material;
  material.name = surface.name;
  material.colour_bgr = surface.colour_bgr;
  material.texture = static_cast<int>(scene.textures.size()) - 1;
  if (surface.texture_edge_m > 0.0F) {
    material.texture_edge_m = surface.texture_edge_m;
  } else {
    material.mapping = TextureMapping::kVertices;
  }
  material.variation = surface.variation;
  material.laser_reflectivity = surface.laser_reflectivity;
  return add_material(scene, material);
}

std::uint16_t add_tinted(Scene& scene, std::uint16_t of, const Eigen::Vector3f& colour_bgr) {
  Material material = scene.materials[of];
  material.colour_bgr = colour_bgr;
  return add_material(scene, material);
}

std::uint16_t add_plain(Scene& scene, const char* name, const Eigen::Vector3f& colour_bgr) {
  Material material;
  material.name = name;
  material.colour_bgr = colour_bgr;
  return add_material(scene, material);
}

void finish_scene(Scene& scene, const FlightLane& lane, std::uint64_t seed) {
  scene.textures.emplace_back(
      procedural_texture(Pattern::kClouds, stirred(seed, scene.textures.size())));
  scene.lighting.cloud_texture = static_cast<int>(scene.textures.size()) - 1;
  scene.route_m = lane.points_m();
  scene.route_closed = lane.closed();
}

std::vector<float> spaced(float from, float to, float step) {
  std::vector<float> result;
  for (int i = 0; from + step * static_cast<float>(i) < to; ++i) {
    result.push_back(from + step * static_cast<float>(i));
  }
  return result;
}

Eigen::Vector3f sun_at(float azimuth_deg, float height_deg) {
  const float degree = std::numbers::pi_v<float> / 180.0F;
  const float level = std::cos(height_deg * degree);
  return {level * std::cos(azimuth_deg * degree),
          level * std::sin(azimuth_deg * degree),
          std::sin(height_deg * degree)};
}

}  // namespace skyhalo
