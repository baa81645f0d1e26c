#include "skyhalo/sphere/grid_geometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "skyhalo/geometry/angle.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

constexpr double kPi = std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

GridBounds bounds_deg(
    double theta_min, double theta_max, double phi_min, double phi_max, double step) {
  return {.theta_min_rad = rad_from_deg(theta_min),
          .theta_max_rad = rad_from_deg(theta_max),
          .phi_min_rad = rad_from_deg(phi_min),
          .phi_max_rad = rad_from_deg(phi_max),
          .step_rad = rad_from_deg(step)};
}

GridBounds thesis_front() {
  return bounds_deg(40, 140, -50, 50, 2);
}

std::optional<GridCell> cell_deg(const GridGeometry& grid, double theta, double phi) {
  return grid.cell_of(rad_from_deg(theta), rad_from_deg(phi));
}

std::string refusal(const GridBounds& bounds) {
  return message_of([&] { (void)make_grid_geometry(bounds); });
}

TEST(GridGeometryTest, TheThesisFrontGridHasFiftyByFiftyCells) {
  const GridGeometry grid = make_grid_geometry(thesis_front());
  EXPECT_EQ(grid.rows, 50);
  EXPECT_EQ(grid.cols, 50);
  EXPECT_EQ(grid.cell_count(), 2500);
  EXPECT_DOUBLE_EQ(grid.theta_min_rad, 40.0 * kPi / 180.0);
  EXPECT_DOUBLE_EQ(grid.phi_min_rad, -50.0 * kPi / 180.0);
  EXPECT_DOUBLE_EQ(grid.theta_step_rad, kPi / 90.0);
  EXPECT_DOUBLE_EQ(grid.phi_step_rad, kPi / 90.0);
}

TEST(GridGeometryTest, TheWholeSphereIsAGrid) {
  const GridGeometry grid = make_grid_geometry(bounds_deg(0, 180, -180, 180, 2));
  EXPECT_EQ(grid.rows, 90);
  EXPECT_EQ(grid.cols, 180);
}

TEST(GridGeometryTest, CellsCountDownwardsAndToTheLeft) {
  const GridGeometry grid = make_grid_geometry(thesis_front());
  EXPECT_EQ(cell_deg(grid, 41, -49), (GridCell{0, 0}));
  EXPECT_EQ(cell_deg(grid, 139, 49), (GridCell{49, 49}));
  EXPECT_EQ(cell_deg(grid, 91, 1), (GridCell{25, 25}));     // (91 - 40) / 2, (1 + 50) / 2
  EXPECT_EQ(cell_deg(grid, 45, -10.5), (GridCell{2, 19}));  // 5 / 2, 39.5 / 2
}

TEST(GridGeometryTest, HasNothingOutsideItsBounds) {
  const GridGeometry grid = make_grid_geometry(thesis_front());
  EXPECT_EQ(cell_deg(grid, 39, 0), std::nullopt);
  EXPECT_EQ(cell_deg(grid, 141, 0), std::nullopt);
  EXPECT_EQ(cell_deg(grid, 90, -51), std::nullopt);
  EXPECT_EQ(cell_deg(grid, 90, 51), std::nullopt);
  EXPECT_EQ(cell_deg(grid, 90, 180), std::nullopt);
  EXPECT_EQ(cell_deg(grid, 90, -180), std::nullopt);
  EXPECT_EQ(cell_deg(grid, 0, 0), std::nullopt);
  EXPECT_EQ(cell_deg(grid, 180, 0), std::nullopt);
}

TEST(GridGeometryTest, AzimuthsWrapBehind) {
  const GridGeometry grid = make_grid_geometry(bounds_deg(40, 140, 150, 210, 10));
  EXPECT_EQ(grid.cols, 6);
  EXPECT_EQ(cell_deg(grid, 45, 155), (GridCell{0, 0}));
  EXPECT_EQ(cell_deg(grid, 45, 175), (GridCell{0, 2}));
  EXPECT_EQ(cell_deg(grid, 45, 179.99), (GridCell{0, 2}));
  EXPECT_EQ(cell_deg(grid, 45, -179.99), (GridCell{0, 3}));
  EXPECT_EQ(cell_deg(grid, 45, -175), (GridCell{0, 3}));
  EXPECT_EQ(cell_deg(grid, 45, -151), (GridCell{0, 5}));
  EXPECT_EQ(cell_deg(grid, 45, -149), std::nullopt);
  EXPECT_EQ(cell_deg(grid, 45, 149), std::nullopt);
  EXPECT_EQ(cell_deg(grid, 45, 0), std::nullopt);
}

TEST(GridGeometryTest, AWholeCircleMayBeginAnywhere) {
  const GridGeometry grid = make_grid_geometry(bounds_deg(0, 180, 90, 450, 10));
  EXPECT_TRUE(grid.is_whole_circle());
  EXPECT_TRUE(grid.reaches_down());
  EXPECT_EQ(cell_deg(grid, 5, 90), (GridCell{0, 0}));
  EXPECT_EQ(cell_deg(grid, 5, 89.9), (GridCell{0, 35}));
  EXPECT_EQ(cell_deg(grid, 5, 0), (GridCell{0, 27}));
  EXPECT_EQ(cell_deg(grid, 5, -180), (GridCell{0, 9}));
}

TEST(GridGeometryTest, TheWholeSphereHasAllDirections) {
  const GridGeometry grid = whole_sphere(rad_from_deg(2.0));
  EXPECT_EQ(grid.rows, 90);
  EXPECT_EQ(grid.cols, 180);
  EXPECT_EQ(cell_deg(grid, 90, 0), (GridCell{45, 90}));
  EXPECT_THAT(testing::message_of([] { (void)whole_sphere(rad_from_deg(7.0)); }),
              HasSubstr("multiple of the step"));
}

TEST(GridGeometryTest, BoundsAreHalfOpen) {
  // Bounds and step that floating point holds exactly: 4 rows and 8 columns of 0.25 rad.
  const GridGeometry grid = make_grid_geometry({.theta_min_rad = 0.5,
                                                .theta_max_rad = 1.5,
                                                .phi_min_rad = -1.0,
                                                .phi_max_rad = 1.0,
                                                .step_rad = 0.25});
  EXPECT_EQ(grid.rows, 4);
  EXPECT_EQ(grid.cols, 8);
  EXPECT_EQ(grid.cell_of(0.5, -1.0), (GridCell{0, 0}));
  EXPECT_EQ(grid.cell_of(0.75, -0.75), (GridCell{1, 1}));
  EXPECT_EQ(grid.cell_of(1.25, 0.75), (GridCell{3, 7}));
  EXPECT_EQ(grid.cell_of(1.5, 0.0), std::nullopt);
  EXPECT_EQ(grid.cell_of(1.0, 1.0), std::nullopt);
}

TEST(GridGeometryTest, StraightBackwardsIsTheFirstColumnOfAWholeCircle) {
  const GridGeometry grid = make_grid_geometry(bounds_deg(0, 180, -180, 180, 10));
  EXPECT_EQ(grid.cell_of(kPi / 2.0 + 0.01, kPi), (GridCell{9, 0}));
  EXPECT_EQ(grid.cell_of(kPi / 2.0 + 0.01, -kPi), (GridCell{9, 0}));
  EXPECT_EQ(cell_deg(grid, 95, 179.9), (GridCell{9, 35}));
}

TEST(GridGeometryTest, StraightDownIsTheLastRow) {
  const GridGeometry grid = make_grid_geometry(bounds_deg(0, 180, -180, 180, 10));
  EXPECT_EQ(grid.cell_of(kPi, 0.01), (GridCell{17, 18}));
  EXPECT_EQ(grid.cell_of(0.0, 0.01), (GridCell{0, 18}));
  // A grid that ends before the pole does not hold it.
  const GridGeometry front = make_grid_geometry(bounds_deg(0, 170, -180, 180, 10));
  EXPECT_EQ(front.cell_of(kPi, 0.01), std::nullopt);
}

TEST(GridGeometryTest, NanHasNoCell) {
  const GridGeometry grid = make_grid_geometry(bounds_deg(0, 180, -180, 180, 10));
  EXPECT_EQ(grid.cell_of(kNan, 0.0), std::nullopt);
  EXPECT_EQ(grid.cell_of(1.0, kNan), std::nullopt);
  EXPECT_EQ(grid.cell_of(kNan, kNan), std::nullopt);
}

TEST(GridGeometryTest, MemoryIsRowMajor) {
  const GridGeometry grid = make_grid_geometry(thesis_front());
  EXPECT_EQ(grid.offset_of({0, 0}), 0);
  EXPECT_EQ(grid.offset_of({0, 49}), 49);
  EXPECT_EQ(grid.offset_of({1, 0}), 50);
  EXPECT_EQ(grid.offset_of({49, 49}), 2499);
}

TEST(GridGeometryTest, CentreDirectionsGoThroughTheMiddle) {
  // Cells of 90 deg: (0, 2) has its middle at theta 45, phi 45: (1/2, 1/2, 1/sqrt 2).
  const GridGeometry grid = make_grid_geometry(bounds_deg(0, 180, -180, 180, 90));
  EXPECT_TRUE(grid.center_direction({0, 2}).isApprox(
      Eigen::Vector3d(0.5, 0.5, 1.0 / std::numbers::sqrt2), 1e-12));
  EXPECT_TRUE(grid.center_direction({1, 0}).isApprox(
      Eigen::Vector3d(-0.5, -0.5, -1.0 / std::numbers::sqrt2), 1e-12));
}

TEST(GridGeometryTest, RefusesAStepThatIsNone) {
  for (const double step : {0.0, -2.0, 180.0, 360.0, kNan}) {
    EXPECT_THAT(refusal(bounds_deg(0, 180, -180, 180, step)), HasSubstr("step"));
  }
}

TEST(GridGeometryTest, RefusesThetaBoundsThatAreNone) {
  EXPECT_THAT(refusal(bounds_deg(-2, 140, -50, 50, 2)), HasSubstr("theta"));
  EXPECT_THAT(refusal(bounds_deg(40, 182, -50, 50, 2)), HasSubstr("theta"));
  EXPECT_THAT(refusal(bounds_deg(140, 40, -50, 50, 2)), HasSubstr("theta"));
  EXPECT_THAT(refusal(bounds_deg(40, 40, -50, 50, 2)), HasSubstr("theta"));
  EXPECT_THAT(refusal(bounds_deg(kNan, 140, -50, 50, 2)), HasSubstr("theta"));
}

TEST(GridGeometryTest, RefusesPhiBoundsThatAreNone) {
  EXPECT_THAT(refusal(bounds_deg(40, 140, -182, 50, 2)), HasSubstr("phi"));
  EXPECT_THAT(refusal(bounds_deg(40, 140, 180, 190, 2)), HasSubstr("phi_min"));
  EXPECT_THAT(refusal(bounds_deg(40, 140, -50, 312, 2)), HasSubstr("phi_max"));
  EXPECT_THAT(refusal(bounds_deg(40, 140, 50, -50, 2)), HasSubstr("phi"));
  EXPECT_THAT(refusal(bounds_deg(40, 140, 50, 50, 2)), HasSubstr("phi"));
  EXPECT_THAT(refusal(bounds_deg(40, 140, -50, kNan, 2)), HasSubstr("phi"));
}

TEST(GridGeometryTest, RefusesBoundsThatAreNoMultipleOfTheStep) {
  EXPECT_THAT(refusal(bounds_deg(41, 140, -50, 50, 2)), HasSubstr("theta_min"));
  EXPECT_THAT(refusal(bounds_deg(40, 141, -50, 50, 2)), HasSubstr("theta_max"));
  EXPECT_THAT(refusal(bounds_deg(40, 140, -51, 50, 2)), HasSubstr("phi_min"));
  EXPECT_THAT(refusal(bounds_deg(40, 140, -50, 51, 2)), HasSubstr("phi_max"));
  EXPECT_THAT(refusal(bounds_deg(40, 140, -50, 50, 7)), HasSubstr("multiple"));
}

TEST(GridGeometryTest, TakesBoundsThatAreMultiplesButForRounding) {
  EXPECT_EQ(make_grid_geometry(bounds_deg(40, 140, -50, 50, 0.1)).cols, 1000);
  EXPECT_EQ(make_grid_geometry(bounds_deg(0, 180, -180, 180, 0.7 / 0.7)).rows, 180);
}

TEST(GridGeometryTest, RefusesTooManyCells) {
  // 0.05 deg: 3600 * 7200 is more than 10^7.
  EXPECT_THAT(refusal(bounds_deg(0, 180, -180, 180, 0.05)), HasSubstr("10^7"));
}

TEST(GridGeometryProperty, EveryCellHoldsItsCentre) {
  for (const GridBounds& bounds : {thesis_front(), bounds_deg(0, 180, -180, 180, 5)}) {
    const GridGeometry grid = make_grid_geometry(bounds);
    for (int i = 0; i < grid.cell_count(); ++i) {
      const GridCell cell{i / grid.cols, i % grid.cols};
      const SphericalPoint point = to_spherical(grid.center_direction(cell));
      EXPECT_NEAR(point.rho_m, 1.0, 1e-12);
      EXPECT_EQ(grid.cell_of(point.theta_rad, point.phi_rad), cell);
    }
  }
}

}  // namespace
}  // namespace skyhalo
