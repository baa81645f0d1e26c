#pragma once

#include <cstdint>
#include <vector>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// The materials of a person.
struct PersonCover {
  std::uint16_t shirt = 0;
  std::uint16_t trousers = 0;
  std::uint16_t skin = 0;
  std::uint16_t hair = 0;
};

/// Length, width and height of `person_mesh` (m).
inline const Eigen::Vector3d kPersonSizeM{0.8, 0.62, 1.78};

/// Adds the materials, in several colours: one cover each.
std::vector<PersonCover> add_person_covers(Scene& scene, std::uint64_t seed);

/// Somebody in the middle of a step: x forward, z up, origin between the feet.
[[nodiscard]] TriangleMesh person_mesh(const PersonCover& cover);

}  // namespace skyhalo
