#include "skyhalo/sim/surface_colour.hpp"

#include <algorithm>
#include <cmath>

#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {
namespace {

using Colour = Eigen::Vector3f;

const TriangleMesh& mesh_of(const Scene& scene, std::uint32_t object) noexcept {
  return object == SceneHit::kFixed ? scene.fixed : scene.movers[object - 1].mesh;
}

/// The value at the hit of something given per vertex.
template <class Value>
Value between(const std::vector<Value>& values,
              const std::array<std::uint32_t, 3>& triangle,
              const SceneHit& hit) noexcept {
  const auto& [a, b, c] = triangle;
  return (1.0F - hit.b - hit.c) * values[a] + hit.b * values[b] + hit.c * values[c];
}

/// Seen along the axis that the triangle faces most.
Eigen::Vector2f seen_along_axis(const Eigen::Vector3f& p, const Eigen::Vector3f& normal) noexcept {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  if (axis == 0) {
    return {p.y(), -p.z()};
  }
  return axis == 1 ? Eigen::Vector2f(p.x(), -p.z()) : Eigen::Vector2f(p.x(), p.y());
}

Colour texture_at(const Texture& texture,
                  const Material& material,
                  const TriangleMesh& mesh,
                  const SceneHit& hit,
                  float footprint_m) noexcept {
  const auto& triangle = mesh.triangles[hit.triangle];
  const auto& [a, b, c] = triangle;
  const Eigen::Vector3f ab = mesh.vertices_m[b] - mesh.vertices_m[a];
  const Eigen::Vector3f ac = mesh.vertices_m[c] - mesh.vertices_m[a];
  const Eigen::Vector3f cross = ab.cross(ac);
  if (material.mapping == TextureMapping::kPosition || mesh.uvs.empty()) {
    const Eigen::Vector2f at =
        seen_along_axis(between(mesh.vertices_m, triangle, hit), cross) / material.texture_edge_m;
    return texture.at(at.x(), at.y(), footprint_m / material.texture_edge_m);
  }
  const Eigen::Vector2f u_ab = mesh.uvs[b] - mesh.uvs[a];
  const Eigen::Vector2f u_ac = mesh.uvs[c] - mesh.uvs[a];
  const float area = std::abs(u_ab.x() * u_ac.y() - u_ab.y() * u_ac.x());
  const float per_m = std::sqrt(area / std::max(cross.norm(), 1e-12F));
  const Eigen::Vector2f at = between(mesh.uvs, triangle, hit);
  return texture.at(at.x(), at.y(), footprint_m * per_m);
}

/// One of 256 brightnesses for each pair of triangles.
float brightness_of(std::uint32_t triangle, float variation) noexcept {
  const auto step = static_cast<float>(stirred(triangle / 2, 0) & 255U) / 255.0F;
  return 1.0F + variation * (step - 0.5F);
}

}  // namespace

Colour SurfaceColour::of_sky(const Eigen::Vector3f& direction, float pixel_rad) const noexcept {
  const Lighting& lighting = scene_.lighting;
  const float up = std::clamp(direction.z(), 0.0F, 1.0F);
  Colour sky = lighting.horizon_bgr + std::sqrt(up) * (lighting.zenith_bgr - lighting.horizon_bgr);
  constexpr float kLowest = 0.03F;  // below, clouds would be pressed together
  if (lighting.cloud_texture >= 0 && up > kLowest) {
    constexpr float kScale = 0.25F;
    const Texture& clouds = scene_.textures[static_cast<std::size_t>(lighting.cloud_texture)];
    const float share = clouds
                            .at(kScale * direction.x() / up,
                                kScale * direction.y() / up,
                                kScale * pixel_rad / (up * up))
                            .mean() *
                        std::min(1.0F, (up - kLowest) * 8.0F);
    sky += share * (Colour::Constant(0.97F) - sky);
  }
  return sky;
}

Colour SurfaceColour::light_at(const Eigen::Vector3f& point_m,
                               const Eigen::Vector3f& normal) const noexcept {
  const Lighting& lighting = scene_.lighting;
  Colour light = lighting.ambient_bgr * (0.75F + 0.25F * normal.z());
  const float facing = normal.dot(lighting.sun_direction);
  if (facing > 0.0F && !lighting.sun_bgr.isZero()) {
    light += lighting.sun_bgr * (facing * shadows_.light(point_m, normal));
  }
  for (const Lamp& lamp : lighting.lamps) {
    const Eigen::Vector3f to_lamp_m = lamp.position_m - point_m;
    const float m2 = std::max(to_lamp_m.squaredNorm(), 0.01F);
    const float cosine = normal.dot(to_lamp_m) / std::sqrt(m2);
    light += lamp.strength_bgr_m2 * (std::max(cosine, 0.0F) / m2);
  }
  return light;
}

Colour SurfaceColour::of(const SceneRay& ray, const SceneHit& hit, float pixel_rad) const noexcept {
  if (hit.object == SceneHit::kNothing) {
    return of_sky(ray.direction, pixel_rad);
  }
  const TriangleMesh& mesh = mesh_of(scene_, hit.object);
  const Material& material = scene_.materials[mesh.materials[hit.triangle]];
  const Eigen::Vector3f point_m = ray.origin_m + hit.range_m * ray.direction;
  const float footprint_m = hit.range_m * pixel_rad;
  Colour colour = material.colour_bgr;
  if (material.texture >= 0) {
    const Texture& texture = scene_.textures[static_cast<std::size_t>(material.texture)];
    colour = colour.cwiseProduct(texture_at(texture, material, mesh, hit, footprint_m));
  }
  if (material.variation > 0.0F) {
    colour *= brightness_of(hit.triangle, material.variation);
  }
  Colour seen = colour.cwiseProduct(light_at(point_m, hit.normal));
  if (material.mirror <= 0.0F) {
    return seen;
  }
  const Eigen::Vector3f mirrored =
      ray.direction - (2.0F * ray.direction.dot(hit.normal)) * hit.normal;
  return seen + material.mirror * (of_sky(mirrored, pixel_rad) - seen);
}

}  // namespace skyhalo
