#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// A kind of scene that can be generated.
struct SceneKind {
  std::string_view name;
  std::string_view what;        ///< a line for lists
  std::string_view difficulty;  ///< what the knob does there
  Scene (*make)(double difficulty, std::uint64_t seed);
};

/// All kinds, in the order of the documentation.
[[nodiscard]] std::span<const SceneKind> scene_kinds() noexcept;

/// What is asked of a generated scene.
struct SceneWish {
  std::string name = "forest";
  double difficulty = 0.5;  ///< 0 (easy) ... 1 (hard)
  std::uint64_t seed = 1;   ///< the same wish gives the same scene
};

/// Throws `Error` (input) with the known names for an unknown one, and for a difficulty outside
/// 0...1.
[[nodiscard]] Scene make_scene(const SceneWish& wish);

}  // namespace skyhalo
