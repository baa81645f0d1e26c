#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace skyhalo {

/// Surfaces whose pictures can be made. Up is up in the picture where a surface has an upright.
enum class Pattern {
  kForestFloor,  ///< soil under dead leaves and twigs
  kGrass,
  kSoil,
  kBark,
  kLeaf,     ///< the inside of foliage; green
  kStone,    ///< rock
  kRipples,  ///< small waves on water
  kClouds,   ///< bright where the sky is covered
  kAsphalt,
  kGravel,
  kBrick,  ///< 16 courses
  kPlaster,
  kConcrete,
  kPlanks,      ///< 8 boards, upright
  kCorrugated,  ///< corrugated sheet, 16 upright waves, some rust
  kFacade,      ///< 4 x 4 windows in plaster
  kPaint,       ///< a wall with nearly nothing to see
  kTiles,       ///< 8 x 8 paving slabs
  kCardboard,   ///< one side of a box with tape, prints and a label
  kCrate,       ///< one side of a wooden crate
  kCloth,       ///< a checked shirt
  kMetal,       ///< scratched and dirty paint
};

/// How many there are; the last is `kMetal`.
constexpr int kPatternCount = static_cast<int>(Pattern::kMetal) + 1;

/// A square picture of a surface whose left edge continues its right one and whose upper edge its
/// lower one. Its contrast goes from its whole width down to single pixels, `kPaint` excepted. The
/// same seed gives the same picture. The side is 512 or 1024 pixels.
[[nodiscard]] cv::Mat3b procedural_texture(Pattern pattern, std::uint64_t seed);

}  // namespace skyhalo
