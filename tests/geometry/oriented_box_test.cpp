#include "skyhalo/geometry/oriented_box.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <random>

#include "reference/naive_oriented_box.hpp"
#include "skyhalo/dataset/kitti_labels.hpp"

namespace skyhalo {
namespace {

/// Corner (1, 2, 3), edges 4 along x, 2 along y, 1 along z.
OrientedBox upright_box() {
  return {Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Vector3d(4.0, 2.0, 1.0).asDiagonal()};
}

/// A square of side sqrt(2) turned by 45 degrees, from z = 0 to 1: its corners lie at (0, 0), (1,
/// 1), (0, 2) and (-1, 1).
OrientedBox turned_box() {
  OrientedBox box;
  box.corner_m.setZero();
  box.edges_m << 1, -1, 0,  //
      1, 1, 0,              //
      0, 0, 1;
  return box;
}

TEST(OrientedBoxTest, HoldsWhatLiesInsideAnUprightBox) {
  EXPECT_TRUE(contains(upright_box(), {3.0, 3.0, 3.5}));
  EXPECT_TRUE(contains(upright_box(), {1.001, 2.001, 3.001}));
  EXPECT_TRUE(contains(upright_box(), {4.999, 3.999, 3.999}));
}

TEST(OrientedBoxTest, TheSurfaceBelongsToTheBox) {
  EXPECT_TRUE(contains(upright_box(), {1.0, 2.0, 3.0}));
  EXPECT_TRUE(contains(upright_box(), {5.0, 4.0, 4.0}));
  EXPECT_TRUE(contains(upright_box(), {5.0, 3.0, 3.5}));
}

TEST(OrientedBoxTest, LeavesOutWhatLiesBeyondAnyFace) {
  EXPECT_FALSE(contains(upright_box(), {0.999, 3.0, 3.5}));
  EXPECT_FALSE(contains(upright_box(), {5.001, 3.0, 3.5}));
  EXPECT_FALSE(contains(upright_box(), {3.0, 1.999, 3.5}));
  EXPECT_FALSE(contains(upright_box(), {3.0, 4.001, 3.5}));
  EXPECT_FALSE(contains(upright_box(), {3.0, 3.0, 2.999}));
  EXPECT_FALSE(contains(upright_box(), {3.0, 3.0, 4.001}));
}

TEST(OrientedBoxTest, FollowsTheTurnOfTheBox) {
  EXPECT_TRUE(contains(turned_box(), {0.0, 1.0, 0.5}));
  EXPECT_TRUE(contains(turned_box(), {0.9, 1.0, 0.5}));
  EXPECT_TRUE(contains(turned_box(), {0.0, 1.9, 0.5}));
  // Inside the upright hull of the four corners, outside the square.
  EXPECT_FALSE(contains(turned_box(), {0.9, 0.2, 0.5}));
  EXPECT_FALSE(contains(turned_box(), {-0.9, 1.8, 0.5}));
  EXPECT_FALSE(contains(turned_box(), {0.0, 1.0, 1.1}));
}

TEST(OrientedBoxTest, TheSenseOfTheEdgesDoesNotMatter) {
  // The upright box from its opposite corner.
  const OrientedBox same{Eigen::Vector3d(5.0, 4.0, 4.0),
                         Eigen::Vector3d(-4.0, -2.0, -1.0).asDiagonal()};
  EXPECT_TRUE(contains(same, {1.5, 3.9, 3.1}));
  EXPECT_FALSE(contains(same, {5.5, 3.9, 3.1}));
  EXPECT_FALSE(contains(same, {1.5, 3.9, 4.1}));
}

TEST(OrientedBoxTest, APointWithANanIsOutside) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(contains(upright_box(), {kNan, 3.0, 3.5}));
  EXPECT_FALSE(contains(upright_box(), {3.0, kNan, 3.5}));
  EXPECT_FALSE(contains(upright_box(), {3.0, 3.0, kNan}));
}

TEST(OrientedBoxProperty, APointIsInsideByItsSharesOfTheEdges) {
  std::mt19937 random(16);
  std::uniform_real_distribution<double> component(-1.0, 1.0);
  std::uniform_real_distribution<double> share(-0.5, 1.5);
  const auto vector = [&] {
    return Eigen::Vector3d(component(random), component(random), component(random));
  };
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Matrix3d R =
        Eigen::Quaterniond(
            1.1 + component(random), component(random), component(random), component(random))
            .normalized()
            .toRotationMatrix();
    const Eigen::Vector3d lengths_m = (vector().array() + 2.0).matrix();
    const OrientedBox box{10.0 * vector(), R * lengths_m.asDiagonal()};
    const Eigen::Array3d shares(share(random), share(random), share(random));
    const bool expected = (shares > 0.0).all() && (shares < 1.0).all();
    EXPECT_EQ(contains(box, box.corner_m + box.edges_m * shares.matrix()), expected);
    inside += expected ? 1 : 0;
  }
  EXPECT_GT(inside, 100);
}

TEST(OrientedBoxReference, AgreesOnRandomLabelBoxes) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> size_m(0.3, 5.0);
  std::uniform_real_distribution<double> center_m(-20.0, 20.0);
  std::uniform_real_distribution<double> rotation_rad(-3.2, 3.2);
  std::uniform_real_distribution<double> offset_m(-4.0, 4.0);
  int inside = 0;
  for (int i = 0; i < 5000; ++i) {
    const LabelBox label{.height_m = size_m(random),
                         .width_m = size_m(random),
                         .length_m = size_m(random),
                         .bottom_center_m = {center_m(random), center_m(random), center_m(random)},
                         .rotation_y_rad = rotation_rad(random)};
    const Eigen::Vector3d& center = label.bottom_center_m;
    const reference::NaiveBox naive{label.height_m,
                                    label.width_m,
                                    label.length_m,
                                    center.x(),
                                    center.y(),
                                    center.z(),
                                    label.rotation_y_rad};
    const Eigen::Vector3d point =
        center + Eigen::Vector3d(offset_m(random), offset_m(random), offset_m(random));
    const bool expected = reference::naive_inside_box(naive, {point.x(), point.y(), point.z()});
    EXPECT_EQ(contains(to_oriented_box(label), point), expected) << "box " << i;
    inside += expected ? 1 : 0;
  }
  EXPECT_GT(inside, 100);
}

}  // namespace
}  // namespace skyhalo
