#include "skyhalo/sim/shapes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace skyhalo {
namespace {

using Eigen::Vector3f;

using Corner = std::array<float, 3>;

Corner corner_of(const Vector3f& p) {
  return {p.x() + 0.0F, p.y() + 0.0F, p.z() + 0.0F};  // no negative zero
}

/// Every edge is gone along once in each direction; corners are the same by place, not by index.
void expect_closed(const TriangleMesh& mesh) {
  std::map<std::pair<Corner, Corner>, int> edges;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner from = corner_of(mesh.vertices_m[triangle[i]]);
      const Corner to = corner_of(mesh.vertices_m[triangle[(i + 1) % 3]]);
      EXPECT_NE(from, to) << "a triangle without area";
      ++edges[{from, to}];
    }
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U);
  }
}

/// By the divergence theorem; positive when triangles turn counter-clockwise seen from outside.
double volume_m3(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume +=
        static_cast<double>(mesh.vertices_m[a].dot(mesh.vertices_m[b].cross(mesh.vertices_m[c])));
  }
  return volume / 6.0;
}

double area_m2(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3f first = mesh.vertices_m[b] - mesh.vertices_m[a];
    const Vector3f second = mesh.vertices_m[c] - mesh.vertices_m[a];
    area += 0.5 * static_cast<double>(first.cross(second).norm());
  }
  return area;
}

void expect_solid(const TriangleMesh& mesh, double expected_m3) {
  EXPECT_NO_THROW(check(mesh, "shape"));
  EXPECT_EQ(mesh.uvs.size(), mesh.vertices_m.size());
  EXPECT_EQ(mesh.triangles.size() % 2, 0U);
  expect_closed(mesh);
  EXPECT_NEAR(volume_m3(mesh), expected_m3, 1e-4 * expected_m3);
}

TEST(ShapesTest, ABoxHasItsSizeAndTurn) {
  TriangleMesh mesh;
  add_box(mesh, {{1.0F, 2.0F, 3.0F}, {2.0F, 3.0F, 4.0F}}, {5, 0.0F});
  expect_solid(mesh, 24.0);
  EXPECT_NEAR(area_m2(mesh), 52.0, 1e-4);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_EQ(mesh.materials.front(), 5);
  TriangleMesh turned;
  add_box(turned, {Vector3f::Zero(), {2.0F, 4.0F, 1.0F}, 0.5F * std::numbers::pi_v<float>}, {});
  EXPECT_TRUE(bounds_of(turned).max().isApprox(Eigen::Vector3d(2.0, 1.0, 0.5), 1e-6));
}

TEST(ShapesTest, ABoxIsCoveredOncePerFaceOrByTheMetre) {
  TriangleMesh whole;
  add_box(whole, {Vector3f::Zero(), {2.0F, 3.0F, 4.0F}}, {0, 0.0F});
  TriangleMesh by_metre;
  add_box(by_metre, {Vector3f::Zero(), {2.0F, 3.0F, 4.0F}}, {0, 2.0F});
  for (const Eigen::Vector2f& uv : whole.uvs) {
    EXPECT_LE(uv.maxCoeff(), 1.0F);
  }
  // The first face is the one at -y: 2 m by 4 m, its lower right corner second.
  EXPECT_EQ(by_metre.uvs[1], Eigen::Vector2f(1.0F, 2.0F));
  EXPECT_EQ(by_metre.vertices_m[1], Vector3f(1.0F, -1.5F, -2.0F));
}

TEST(ShapesTest, ATubeIsAPrismATaperedOneAFrustum) {
  // A regular hexagon of radius r has the area 3/2 sqrt(3) r^2.
  const double hexagon = 1.5 * std::sqrt(3.0);
  TriangleMesh tube;
  add_tube(tube, {{0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 3.0F}, 0.5F, 0.5F, 6}, {});
  expect_solid(tube, hexagon * 0.25 * 2.0);
  TriangleMesh frustum;
  add_tube(frustum, {{1.0F, 2.0F, 3.0F}, {1.0F, 6.0F, 3.0F}, 1.0F, 0.5F, 6}, {0, 0.7F});
  expect_solid(frustum, hexagon * 4.0 / 3.0 * (1.0 + 0.5 + 0.25));
  TriangleMesh cone;
  add_tube(cone, {{0.0F, 0.0F, 0.0F}, {3.0F, 0.0F, 4.0F}, 1.0F, 0.0F, 6}, {});
  expect_solid(cone, hexagon * 5.0 / 3.0);
}

TEST(ShapesTest, APrismKeepsItsOutline) {
  TriangleMesh mesh;
  add_prism(mesh,
            {.outline_m = {{0.0F, 0.0F}, {3.0F, 0.0F}, {2.0F, 1.0F}, {0.0F, 1.0F}},
             .middle_m = {5.0F, 6.0F, 7.0F},
             .width_m = 2.0F,
             .yaw_rad = 0.3F},
            {});
  expect_solid(mesh, 5.0);  // a trapezoid of 2.5 m2, 2 m wide
  EXPECT_NEAR(bounds_of(mesh).min().z(), 7.0, 1e-6);
}

TEST(ShapesTest, AnEllipsoidIsNearlyOne) {
  TriangleMesh mesh;
  add_ellipsoid(mesh, {{1.0F, 1.0F, 1.0F}, {1.0F, 2.0F, 3.0F}, 64, 64}, {});
  expect_closed(mesh);
  EXPECT_NEAR(volume_m3(mesh), 4.0 / 3.0 * std::numbers::pi * 6.0, 0.1);
  EXPECT_TRUE(bounds_of(mesh).max().isApprox(Eigen::Vector3d(2.0, 3.0, 4.0), 1e-3));
  TriangleMesh octahedron;
  add_ellipsoid(octahedron, {Vector3f::Zero(), Vector3f::Ones(), 4, 2}, {});
  expect_solid(octahedron, 4.0 / 3.0);
}

TEST(ShapesTest, ARockIsClosedAndStaysInItsBounds) {
  TriangleMesh mesh;
  add_rock(mesh, {Vector3f::Zero(), Vector3f::Ones(), 12, 8}, 0.3F, 5, {});
  expect_closed(mesh);
  for (const Vector3f& vertex : mesh.vertices_m) {
    EXPECT_GE(vertex.norm(), 0.7F - 1e-5F);
    EXPECT_LE(vertex.norm(), 1.3F + 1e-5F);
  }
  TriangleMesh again;
  add_rock(again, {Vector3f::Zero(), Vector3f::Ones(), 12, 8}, 0.3F, 5, {});
  EXPECT_EQ(again.vertices_m, mesh.vertices_m);
}

TEST(ShapesTest, ALeafIsTwoTriangles) {
  TriangleMesh mesh;
  add_leaf(
      mesh, {Vector3f::Zero(), {0.1F, 0.0F, 0.0F}, {0.0F, 0.05F, 0.0F}, {0.3F, 0.6F}}, 0.2F, 3);
  EXPECT_NO_THROW(check(mesh, "leaf"));
  EXPECT_EQ(mesh.triangles.size(), 2U);
  EXPECT_NEAR(area_m2(mesh), 0.01, 1e-7);  // half of 0.2 m by 0.1 m
  EXPECT_EQ(mesh.uvs[0], Eigen::Vector2f(0.3F, 0.6F));
}

TEST(ShapesTest, GroundFollowsItsHeight) {
  TriangleMesh mesh;
  add_ground(mesh,
             {{-2.0F, 0.0F}, {2.0F, 3.0F}, 4, 3},
             [](float x, float y) { return 0.75F * x + 0.0F * y; },
             {1, 2.0F});
  EXPECT_NO_THROW(check(mesh, "ground"));
  EXPECT_EQ(mesh.triangles.size(), 24U);
  EXPECT_NEAR(area_m2(mesh), 12.0 * 1.25, 1e-4);  // a slope of 3 to 4 is 5/4 as long
  EXPECT_EQ(mesh.vertices_m.front(), Vector3f(-2.0F, 0.0F, -1.5F));
  EXPECT_EQ(mesh.vertices_m.back(), Vector3f(2.0F, 3.0F, 1.5F));
  EXPECT_EQ(mesh.uvs.back(), Eigen::Vector2f(2.0F, -1.5F));
  for (const auto& [a, b, c] : mesh.triangles) {  // seen from above
    const Vector3f first = mesh.vertices_m[b] - mesh.vertices_m[a];
    EXPECT_GT(first.cross(mesh.vertices_m[c] - mesh.vertices_m[a]).z(), 0.0F);
  }
}

}  // namespace
}  // namespace skyhalo
