#pragma once

#include <cstdint>
#include <vector>

#include "skyhalo/sim/procedural_texture.hpp"
#include "skyhalo/sim/scene.hpp"
#include "skyhalo/sim/scenes/flight_lane.hpp"

namespace skyhalo {

/// A surface of a generated scene.
struct Surface {
  const char* name = "";
  Pattern pattern = Pattern::kConcrete;
  float texture_edge_m = 0.0F;  ///< > 0: by position; 0: by the vertices' places in the texture
  Eigen::Vector3f colour_bgr = Eigen::Vector3f::Ones();
  float variation = 0.0F;
  float laser_reflectivity = 0.4F;
};

/// Paints the surface's texture and adds both; gives the material's index.
std::uint16_t add_surface(Scene& scene, const Surface& surface, std::uint64_t seed);

/// The same with the texture faded towards its mean colour: 0 leaves it, 1 makes it uniform.
std::uint16_t add_faded(Scene& scene, const Surface& surface, float fade, std::uint64_t seed);

/// A material with the texture of another one in another colour; gives its index.
std::uint16_t add_tinted(Scene& scene, std::uint16_t of, const Eigen::Vector3f& colour_bgr);

/// A material of one colour without texture; gives its index.
std::uint16_t add_plain(Scene& scene, const char* name, const Eigen::Vector3f& colour_bgr);

/// Gives the scene its route and clouds.
void finish_scene(Scene& scene, const FlightLane& lane, std::uint64_t seed);

/// From `easy` at difficulty 0 to `hard` at 1.
[[nodiscard]] constexpr float graded(double difficulty, float easy, float hard) noexcept {
  return easy + static_cast<float>(difficulty) * (hard - easy);
}

/// The same as a whole number, rounded down.
[[nodiscard]] constexpr int graded_count(double difficulty, int easy, int hard) noexcept {
  return easy + static_cast<int>(difficulty * (hard - easy));
}

/// `from`, `from` + `step`, ... as long as they are less than `to`; `step` > 0.
[[nodiscard]] std::vector<float> spaced(float from, float to, float step);

/// The direction to a sun at this azimuth (from x towards y) and height over the horizon.
[[nodiscard]] Eigen::Vector3f sun_at(float azimuth_deg, float height_deg);

}  // namespace skyhalo
