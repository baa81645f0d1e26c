#include "skyhalo/sim/triangle_mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using ::testing::HasSubstr;
using testing::message_of;
using ::testing::StartsWith;

/// One triangle with corners on the axes.
TriangleMesh corner() {
  TriangleMesh mesh;
  mesh.vertices_m = {
      Vector3f(1.0F, 0.0F, 0.0F), Vector3f(0.0F, 2.0F, 0.0F), Vector3f(0.0F, 0.0F, 3.0F)};
  mesh.triangles = {{0, 1, 2}};
  mesh.materials = {4};
  return mesh;
}

std::string complaint(const TriangleMesh& mesh) {
  return message_of([&] { check(mesh, "it"); });
}

TEST(TriangleMeshTest, APartIsMovedAndItsIndicesAreShifted) {
  TriangleMesh whole = corner();
  const Eigen::AngleAxisd turn(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ());
  append(whole, corner(), make_pose(turn.toRotationMatrix(), {10.0, 0.0, 1.0}));
  ASSERT_EQ(whole.vertices_m.size(), 6U);
  EXPECT_TRUE(whole.vertices_m[3].isApprox(Vector3f(10.0F, 1.0F, 1.0F), 1e-6F));
  EXPECT_TRUE(whole.vertices_m[4].isApprox(Vector3f(8.0F, 0.0F, 1.0F), 1e-6F));
  EXPECT_EQ(whole.triangles[1], (std::array<std::uint32_t, 3>{3, 4, 5}));
  EXPECT_EQ(whole.materials, (std::vector<std::uint16_t>{4, 4}));
  EXPECT_TRUE(whole.uvs.empty());
  EXPECT_NO_THROW(check(whole, "whole"));
}

TEST(TriangleMeshTest, PlacesInTheTextureAreZeroWhereOnePartHasNone) {
  TriangleMesh placed = corner();
  placed.uvs.assign(3, Vector2f(0.5F, 0.25F));
  TriangleMesh first = corner();
  append(first, placed, Pose::Identity());
  ASSERT_EQ(first.uvs.size(), 6U);
  EXPECT_EQ(first.uvs[0], Vector2f::Zero());
  EXPECT_EQ(first.uvs[5], Vector2f(0.5F, 0.25F));
  append(placed, corner(), Pose::Identity());
  ASSERT_EQ(placed.uvs.size(), 6U);
  EXPECT_EQ(placed.uvs[0], Vector2f(0.5F, 0.25F));
  EXPECT_EQ(placed.uvs[5], Vector2f::Zero());
}

TEST(TriangleMeshTest, BoundsReachAllVertices) {
  const Eigen::AlignedBox3d box = bounds_of(corner());
  EXPECT_EQ(box.min(), Eigen::Vector3d::Zero());
  EXPECT_EQ(box.max(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_TRUE(bounds_of(TriangleMesh()).isEmpty());
}

TEST(TriangleMeshTest, WhatIsWrongIsNamed) {
  EXPECT_EQ(complaint(TriangleMesh()), "it: holds no triangle");
  for (const float wrong : {std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity(),
                            -1.01e5F}) {
    TriangleMesh mesh = corner();
    mesh.vertices_m[1].y() = wrong;
    EXPECT_THAT(complaint(mesh), StartsWith("it: vertex 1: a coordinate is not finite"));
  }
  TriangleMesh mesh = corner();
  mesh.triangles[0][2] = 3;
  EXPECT_EQ(complaint(mesh), "it: triangle 0: there is no vertex 3");
  mesh = corner();
  mesh.materials.push_back(0);
  EXPECT_THAT(complaint(mesh), HasSubstr("each triangle needs one material"));
  mesh = corner();
  mesh.uvs.resize(2);
  EXPECT_THAT(complaint(mesh), HasSubstr("each vertex or none"));
}

}  // namespace
}  // namespace skyhalo
