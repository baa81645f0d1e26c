#include "skyhalo/sim/scenes/plants.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "skyhalo/sim/shapes.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3f;

constexpr float kTurnRad = 2.0F * std::numbers::pi_v<float>;
constexpr float kBarkEdgeM = 1.2F;

bool is_clear(const Plot& plot, const Vector3f& point_m, float reach_m) {
  return plot.lane.distance_m(point_m) > kLaneM + reach_m;
}

/// Leaves round a middle, the more towards its surface; those in the lane are left out.
void add_leaves(Plot& plot,
                const EllipsoidShape& clump,
                int count,
                float half_length_m,
                std::uint16_t material) {
  RandomNumbers& random = plot.random;
  const bool aside = is_clear(plot, clump.middle_m, 1.5F * clump.radius_m.maxCoeff() + 1.0F);
  for (int i = 0; i < count; ++i) {
    const Vector3f outwards = random.normal_vector().normalized();
    const float reach = std::sqrt(random.uniform(0.12F, 1.2F));
    const float half_m = half_length_m * random.uniform(0.65F, 1.35F);
    const Vector3f normal = (outwards + 0.7F * random.normal_vector()).normalized();
    const Vector3f along = normal.cross(random.normal_vector()).normalized();
    const float u = random.uniform();
    const LeafShape leaf{.middle_m = clump.middle_m + reach * outwards.cwiseProduct(clump.radius_m),
                         .along_m = half_m * along,
                         .aside_m = 0.62F * half_m * normal.cross(along),
                         .uv = {u, random.uniform()}};
    if (aside || is_clear(plot, leaf.middle_m, half_m)) {
      add_leaf(plot.mesh, leaf, 0.15F, material);
    }
  }
}

/// A clump: leaves round a rough core that cannot be seen through.
void add_clump(Plot& plot, const EllipsoidShape& clump, int leaves, std::uint16_t material) {
  EllipsoidShape core = clump;
  core.radius_m *= 0.5F;
  if (is_clear(plot, clump.middle_m, core.radius_m.maxCoeff() * 1.5F)) {
    add_rock(plot.mesh, core, 0.5F, plot.random.bits(), {material, 1.2F});
  }
  add_leaves(plot, clump, leaves, 0.15F, material);
}

/// A bar of wood unless it would reach into the lane.
void add_wood(Plot& plot, const TubeShape& tube, std::uint16_t material) {
  for (int i = 0; i <= 4; ++i) {
    const float share = static_cast<float>(i) / 4.0F;
    const Vector3f at = tube.from_m + share * (tube.to_m - tube.from_m);
    if (!is_clear(plot, at, std::max(tube.from_radius_m, tube.to_radius_m))) {
      return;
    }
  }
  add_tube(plot.mesh, tube, {material, kBarkEdgeM});
}

/// The trunk, a little bent, from below the ground to `height_m`; gives its top.
Vector3f add_trunk(Plot& plot, const TreeShape& tree, float height_m, std::uint16_t bark) {
  constexpr int kPieces = 4;
  Vector3f from = tree.foot_m - Vector3f(0.0F, 0.0F, 0.4F);
  const float top_radius_m = 0.25F * tree.trunk_radius_m;
  for (int i = 0; i < kPieces; ++i) {
    const float share = static_cast<float>(i + 1) / kPieces;
    const float bend = 0.012F * tree.height_m;
    const float x = bend * plot.random.normal();
    const Vector3f to = Vector3f(
        from.x() + x, from.y() + bend * plot.random.normal(), tree.foot_m.z() + share * height_m);
    const float lower = std::lerp(tree.trunk_radius_m, top_radius_m, share - 1.0F / kPieces);
    const float flare = i == 0 ? 1.25F : 1.0F;
    add_tube(plot.mesh,
             {from, to, flare * lower, std::lerp(tree.trunk_radius_m, top_radius_m, share), 8},
             {bark, kBarkEdgeM});
    from = to;
  }
  return from;
}

Vector3f level_direction(float angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad), 0.0F};
}

/// A branch from the trunk outwards; gives where it ends.
Vector3f add_branch(Plot& plot,
                    const TreeShape& tree,
                    const Vector3f& from_m,
                    const Vector3f& reach_m,
                    std::uint16_t bark) {
  Vector3f to = from_m + reach_m;
  const float radius_m = tree.branch_radius_m * plot.random.uniform(0.7F, 1.3F);
  add_wood(plot, {from_m, to, radius_m, 0.3F * radius_m, 4}, bark);
  return to;
}

}  // namespace

void add_broadleaf(Plot& plot, const TreeShape& tree, const PlantCover& cover) {
  RandomNumbers& random = plot.random;
  const Vector3f top = add_trunk(plot, tree, 0.85F * tree.height_m, cover.bark);
  const Vector3f foot = tree.foot_m;
  const int clumps = std::clamp(static_cast<int>(tree.crown_radius_m * 4.0F), 6, 16);
  const int leaves = tree.leaves / clumps;
  for (int i = 0; i < clumps; ++i) {
    const float share = (static_cast<float>(i) + 0.5F) / static_cast<float>(clumps);
    const float z = std::lerp(tree.crown_from_m, 0.82F * tree.height_m, share);
    const Vector3f from = foot + (z / (0.85F * tree.height_m)) * (top - foot);
    const float swell = std::sqrt(std::max(0.15F, 1.0F - std::pow(1.7F * share - 0.6F, 2.0F)));
    const float reach_m = tree.crown_radius_m * swell * random.uniform(0.45F, 0.85F);
    const Vector3f way =
        level_direction(kTurnRad * (0.382F * static_cast<float>(i)) + random.uniform(-0.4F, 0.4F));
    const Vector3f end =
        add_branch(plot,
                   tree,
                   from,
                   reach_m * (way + random.uniform(0.2F, 0.6F) * Vector3f::UnitZ()),
                   cover.bark);
    const float size_m = tree.crown_radius_m * random.uniform(0.32F, 0.5F);
    add_clump(
        plot, {.middle_m = end, .radius_m = {size_m, size_m, 0.7F * size_m}}, leaves, cover.leaf);
  }
  const float size_m = 0.5F * tree.crown_radius_m;
  add_clump(plot, {.middle_m = top, .radius_m = {size_m, size_m, size_m}}, leaves, cover.leaf);
}

void add_conifer(Plot& plot, const TreeShape& tree, const PlantCover& cover) {
  RandomNumbers& random = plot.random;
  const Vector3f top = add_trunk(plot, tree, tree.height_m, cover.bark);
  const Vector3f foot = tree.foot_m;
  const int storeys = std::max(6, static_cast<int>((tree.height_m - tree.crown_from_m) / 0.75F));
  const int leaves = tree.leaves / (storeys * 6);
  for (int i = 0; i < storeys; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(storeys);
    const float z = std::lerp(tree.crown_from_m, tree.height_m, share);
    const Vector3f from = foot + (z / tree.height_m) * (top - foot);
    const float reach_m = tree.crown_radius_m * (1.0F - 0.92F * share);
    for (int k = 0; k < 6; ++k) {
      const Vector3f way = level_direction(kTurnRad * static_cast<float>(k) / 6.0F +
                                           static_cast<float>(i) + random.uniform(-0.3F, 0.3F));
      const Vector3f reach =
          reach_m * random.uniform(0.8F, 1.15F) * (way - 0.25F * Vector3f::UnitZ());
      add_branch(plot, tree, from, reach, cover.bark);
      const float wide = 0.26F * reach_m + 0.1F;
      add_leaves(plot,
                 {.middle_m = from + 0.4F * reach, .radius_m = {wide, wide, 0.16F}},
                 leaves / 2,
                 0.17F,
                 cover.leaf);
      add_leaves(plot,
                 {.middle_m = from + 0.8F * reach, .radius_m = {wide, wide, 0.14F}},
                 leaves - leaves / 2,
                 0.17F,
                 cover.leaf);
    }
  }
}

void add_snag(Plot& plot, const TreeShape& tree, const PlantCover& cover) {
  const Vector3f top = add_trunk(plot, tree, tree.height_m, cover.bark);
  for (int i = 0; i < 9; ++i) {
    const Vector3f from = tree.foot_m + plot.random.uniform(0.3F, 0.98F) * (top - tree.foot_m);
    const Vector3f way = level_direction(plot.random.uniform(0.0F, kTurnRad));
    const Vector3f reach = plot.random.uniform(0.6F, tree.crown_radius_m) *
                           (way + plot.random.uniform(-0.1F, 0.5F) * Vector3f::UnitZ());
    const Vector3f end = add_branch(plot, tree, from, reach, cover.bark);
    TreeShape twig = tree;
    twig.branch_radius_m *= 0.4F;
    add_branch(plot,
               twig,
               end,
               0.5F * reach.norm() * plot.random.normal_vector().normalized(),
               cover.bark);
  }
}

void add_bush(Plot& plot, const Vector3f& foot_m, float radius_m, const PlantCover& cover) {
  for (int i = 0; i < 3; ++i) {
    const float x = 0.5F * radius_m * plot.random.normal();
    const Vector3f aside(x, 0.5F * radius_m * plot.random.normal(), 0.55F * radius_m);
    const float size_m = radius_m * plot.random.uniform(0.5F, 0.8F);
    const int leaves = 30 + static_cast<int>(70.0F * radius_m);
    add_clump(plot,
              {.middle_m = foot_m + aside, .radius_m = {size_m, size_m, size_m}},
              leaves,
              cover.leaf);
  }
}

void add_tuft(Plot& plot, const TuftShape& tuft, std::uint16_t material) {
  RandomNumbers& random = plot.random;
  for (int i = 0; i < tuft.blades; ++i) {
    const Vector3f way = level_direction(random.uniform(0.0F, kTurnRad));
    const float height_m = tuft.height_m * random.uniform(0.6F, 1.1F);
    const Vector3f along = height_m * (Vector3f::UnitZ() + tuft.lean * random.uniform() * way);
    const float u = random.uniform();
    const LeafShape blade{
        .middle_m = tuft.foot_m + 0.1F * tuft.height_m * way + 0.45F * along,
        .along_m = 0.5F * along,
        .aside_m = 0.5F * tuft.width_m * along.cross(way + Vector3f(0.1F, 0.2F, 0.0F)).normalized(),
        .uv = {u, random.uniform()}};
    if (is_clear(plot, blade.middle_m, 0.6F * height_m)) {
      add_leaf(plot.mesh, blade, 0.15F, material);
    }
  }
}

}  // namespace skyhalo
