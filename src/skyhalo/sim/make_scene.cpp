#include "skyhalo/sim/make_scene.hpp"

#include <algorithm>
#include <array>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/sim/scenes/fence.hpp"
#include "skyhalo/sim/scenes/forest.hpp"
#include "skyhalo/sim/scenes/street.hpp"
#include "skyhalo/sim/scenes/tunnel.hpp"
#include "skyhalo/sim/scenes/warehouse.hpp"
#include "skyhalo/sim/scenes/water.hpp"
#include "skyhalo/sim/scenes/wires.hpp"
#include "skyhalo/sim/scenes/yard.hpp"

namespace skyhalo {
namespace {

constexpr std::array kKinds{
    SceneKind{"forest",
              "a wood on gentle hills with undergrowth, rocks and fallen trunks",
              "more trees and undergrowth, thinner branches, a lower sun",
              make_forest},
    SceneKind{"street",
              "a street between tall houses with trees, lamp posts and parked cars",
              "more blank glass, fainter fronts, more parked cars",
              make_street},
    SceneKind{"warehouse",
              "a hall with tall shelves full of boxes",
              "narrower aisles, more boxes that are all the same",
              make_warehouse},
    SceneKind{"tunnel",
              "a long bent corridor with lamps, pipes and doors",
              "blanker walls; at 1 perfectly uniform ones",
              make_tunnel},
    SceneKind{"fence",
              "a sports ground behind nets, pales and railings that repeat",
              "finer nets and fences",
              make_fence},
    SceneKind{"wires",
              "fields with poles, cables, guy ropes and masts",
              "thinner wires: 6 cm to 8 mm across",
              make_wires},
    SceneKind{"water",
              "a lake under clouds with a jetty, reeds and boats",
              "calmer water that reflects more of the sky",
              make_water},
    SceneKind{"yard",
              "a yard between garages and containers with moving cars and people",
              "more that moves, and faster",
              make_yard},
};

std::string known_names() {
  std::string names;
  for (const SceneKind& kind : kKinds) {
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  }
  return names;
}

}  // namespace

std::span<const SceneKind> scene_kinds() noexcept {
  return kKinds;
}

Scene make_scene(const SceneWish& wish) {
  const auto* const kind = std::find_if(
      kKinds.begin(), kKinds.end(), [&](const SceneKind& each) { return each.name == wish.name; });
  if (kind == kKinds.end()) {
    throw Error(ErrorKind::kInput, "unknown scene \"" + wish.name + "\"; known: " + known_names());
  }
  if (!(wish.difficulty >= 0.0 && wish.difficulty <= 1.0)) {
    throw Error(ErrorKind::kInput,
                "scene \"" + wish.name + "\": the difficulty must be in 0...1, got " +
                    number_text("%g", wish.difficulty));
  }
  return kind->make(wish.difficulty, wish.seed);
}

}  // namespace skyhalo
