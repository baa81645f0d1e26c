#include "skyhalo/sim/scenes/site_parts.hpp"

#include <cmath>

namespace skyhalo {
namespace {

using Eigen::Vector3f;

/// What lies at `offset_m` in the axes of a box.
Vector3f beside(const BoxShape& box, const Vector3f& offset_m) {
  const float c = std::cos(box.yaw_rad);
  const float s = std::sin(box.yaw_rad);
  return box.middle_m + Vector3f(c * offset_m.x() - s * offset_m.y(),
                                 s * offset_m.x() + c * offset_m.y(),
                                 offset_m.z());
}

}  // namespace

void add_block(TriangleMesh& mesh, const BoxShape& block, const HouseCover& cover) {
  add_box(mesh, block, {cover.wall, cover.wall_edge_m});
  const float top_m = 0.5F * block.size_m.z();
  add_box(mesh,
          {beside(block, {0.0F, 0.0F, top_m + 0.15F}),
           {block.size_m.x() + 0.02F, block.size_m.y() + 0.5F, 0.4F},
           block.yaw_rad},
          {cover.trim, 2.0F});
}

void add_gabled_house(TriangleMesh& mesh, const BoxShape& house, const HouseCover& cover) {
  add_box(mesh, house, {cover.wall, cover.wall_edge_m});
  const float half_m = 0.5F * house.size_m.y() + 0.4F;
  const float rise_m = 0.7F * half_m;
  const float turn_rad = house.yaw_rad + 1.5707963F;  // the outline runs across the ridge
  add_prism(mesh,
            {.outline_m = {{-half_m, -0.02F}, {half_m, -0.02F}, {0.02F, rise_m}, {-0.02F, rise_m}},
             .middle_m = beside(house, {0.0F, 0.0F, 0.5F * house.size_m.z()}),
             .width_m = house.size_m.x() + 0.6F,
             .yaw_rad = turn_rad},
            {cover.roof, 3.0F});
  add_box(mesh,
          {beside(house, {0.25F * house.size_m.x(), 0.0F, 0.5F * house.size_m.z() + rise_m}),
           {0.7F, 0.7F, 1.2F},
           house.yaw_rad},
          {cover.trim, 2.0F});
}

void add_lamp_post(
    TriangleMesh& mesh, const Vector3f& foot_m, float height_m, float yaw_rad, const Cover& cover) {
  const Vector3f top = foot_m + Vector3f(0.0F, 0.0F, height_m);
  const Vector3f way(std::cos(yaw_rad), std::sin(yaw_rad), 0.0F);
  add_tube(mesh, {foot_m - Vector3f(0.0F, 0.0F, 0.1F), top, 0.09F, 0.06F, 8}, cover);
  add_tube(mesh, {top, top + 1.4F * way + Vector3f(0.0F, 0.0F, 0.15F), 0.045F, 0.04F, 6}, cover);
  add_box(
      mesh, {top + 1.6F * way + Vector3f(0.0F, 0.0F, 0.13F), {0.6F, 0.25F, 0.12F}, yaw_rad}, cover);
}

void add_cable(TriangleMesh& mesh, const CableShape& cable, std::uint16_t material) {
  const auto at = [&](int i) -> Vector3f {
    const float share = static_cast<float>(i) / static_cast<float>(cable.pieces);
    const float drop_m = 4.0F * cable.sag_m * share * (1.0F - share);
    return cable.from_m + share * (cable.to_m - cable.from_m) - Vector3f(0.0F, 0.0F, drop_m);
  };
  for (int i = 0; i < cable.pieces; ++i) {
    add_tube(mesh, {at(i), at(i + 1), cable.radius_m, cable.radius_m, 4}, {material, 0.5F});
  }
}

void add_container(TriangleMesh& mesh,
                   const Vector3f& place_m,
                   float yaw_rad,
                   std::uint16_t sheet,
                   std::uint16_t frame) {
  const BoxShape box{place_m + Vector3f(0.0F, 0.0F, 1.32F), {5.9F, 2.3F, 2.5F}, yaw_rad};
  add_box(mesh, box, {sheet, 2.4F});
  for (const float x : {-2.95F, 2.95F}) {
    for (const float y : {-1.15F, 1.15F}) {
      add_box(mesh, {beside(box, {x, y, 0.0F}), {0.16F, 0.16F, 2.62F}, yaw_rad}, {frame, 1.0F});
    }
  }
}

}  // namespace skyhalo
