#include "skyhalo/sim/procedural_texture.hpp"

#include "skyhalo/sim/built_patterns.hpp"
#include "skyhalo/sim/goods_patterns.hpp"
#include "skyhalo/sim/natural_patterns.hpp"
#include "skyhalo/sim/pattern_paint.hpp"

namespace skyhalo {
namespace {

cv::Mat3f painted(Pattern pattern, std::uint64_t seed) {
  switch (pattern) {
    case Pattern::kForestFloor:
      return paint_forest_floor(seed);
    case Pattern::kGrass:
      return paint_grass(seed);
    case Pattern::kSoil:
      return paint_soil(seed);
    case Pattern::kBark:
      return paint_bark(seed);
    case Pattern::kLeaf:
      return paint_leaf(seed);
    case Pattern::kStone:
      return paint_stone(seed);
    case Pattern::kRipples:
      return paint_ripples(seed);
    case Pattern::kClouds:
      return paint_clouds(seed);
    case Pattern::kAsphalt:
      return paint_asphalt(seed);
    case Pattern::kGravel:
      return paint_gravel(seed);
    case Pattern::kBrick:
      return paint_brick(seed);
    case Pattern::kPlaster:
      return paint_plaster(seed);
    case Pattern::kConcrete:
      return paint_concrete(seed);
    case Pattern::kPlanks:
      return paint_planks(seed);
    case Pattern::kCorrugated:
      return paint_corrugated(seed);
    case Pattern::kFacade:
      return paint_facade(seed);
    case Pattern::kPaint:
      return paint_wall_paint(seed);
    case Pattern::kTiles:
      return paint_tiles(seed);
    case Pattern::kCardboard:
      return paint_cardboard(seed);
    case Pattern::kCrate:
      return paint_crate(seed);
    case Pattern::kCloth:
      return paint_cloth(seed);
    case Pattern::kMetal:
      return paint_metal(seed);
  }
  return paint_concrete(seed);
}

}  // namespace

cv::Mat3b procedural_texture(Pattern pattern, std::uint64_t seed) {
  return finished(painted(pattern, seed));
}

}  // namespace skyhalo
