#include "skyhalo/sim/trajectory_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "sim/motion_checks.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/sim/thrust_attitude.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using testing::extremes_of;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

class TrajectoryTextTest : public ::testing::Test {
 protected:
  [[nodiscard]] Trajectory read(const std::string& text) const {
    return read_trajectory(folder.write("flight.txt", text));
  }

  [[nodiscard]] std::string message(const std::string& text) const {
    const std::string whole = message_of([&] { (void)read(text); });
    const std::size_t at = whole.find("flight.txt");
    EXPECT_NE(at, std::string::npos) << whole;
    return at == std::string::npos ? whole : whole.substr(at);
  }

  TempFolder folder;
};

TEST_F(TrajectoryTextTest, ReadsTum) {
  const Trajectory flight = read(
      "# timestamp tx ty tz qx qy qz qw\r\n"
      "1403636579.5 1 2 3 0 0 0 2\r\n"
      "\n"
      "1403636580.5\t+3 2  3 0 0 0.70710678 0.70710678 \n"
      "  # a remark\n"
      "1403636581.5 5 2 3 0 0 1 0");
  ASSERT_EQ(flight.samples().size(), 3U);
  EXPECT_DOUBLE_EQ(flight.duration_s(), 2.0);
  const Pose T = flight.T_map_body(0.5);
  const Eigen::AngleAxisd eighth(0.25 * std::numbers::pi, Eigen::Vector3d::UnitZ());
  EXPECT_LE((T.translation() - Eigen::Vector3d(2, 2, 3)).norm(), 1e-12);
  EXPECT_LE((T.linear() - eighth.toRotationMatrix()).norm(), 1e-7);
  EXPECT_LE((flight.velocity_mps(1.7) - Eigen::Vector3d(2, 0, 0)).norm(), 1e-12);
}

TEST_F(TrajectoryTextTest, FliesRowsWithoutTimesAsWaypoints) {
  const Trajectory flight = read("\xEF\xBB\xBFz_m, x_m ,y_m\n1,0,0\n1,5,0\n2,5,5\n");
  const Trajectory expected = fly_waypoints({{0, 0, 1}, {5, 0, 1}, {5, 5, 2}}, {}, false);
  EXPECT_EQ(flight.duration_s(), expected.duration_s());
  EXPECT_EQ(flight.T_map_body(1.5).matrix(), expected.T_map_body(1.5).matrix());
}

TEST_F(TrajectoryTextTest, FliesWaypointsWithTheOptions) {
  const auto file = folder.write("square.csv", "x_m,y_m,z_m\n0,0,1\n9,0,1\n9,9,1\n");
  WaypointOptions options;
  options.is_closed = true;
  options.limits.speed_mps = 1.0;
  const Trajectory flight = read_trajectory(file, options);
  EXPECT_LE(extremes_of(flight).speed_mps, 1.0);
  EXPECT_LE((flight.T_map_body(1e9).translation() - Eigen::Vector3d(0, 0, 1)).norm(), 1e-3);
}

// x = t^2: 2 m/s^2 ahead at every moment, which the rows' parabolas keep.
TEST_F(TrajectoryTextTest, DipsItsNoseOnATimedCurveThatSpeedsUp) {
  const Trajectory flight = read("t_s,x_m,y_m,z_m\n5,0,0,1\n6,1,0,1\n7,4,0,1\n8,9,0,1\n");
  EXPECT_DOUBLE_EQ(flight.duration_s(), 3.0);
  const Eigen::AngleAxisd down(std::atan(2.0 / kGravityMps2), Eigen::Vector3d::UnitY());
  for (const double t_s : {0.5, 1.0, 1.77, 3.0}) {
    const Pose T = flight.T_map_body(t_s);
    EXPECT_NEAR(T.translation().x(), t_s * t_s, 1e-9);
    EXPECT_LE((T.linear() - down.toRotationMatrix()).norm(), 1e-9);
    EXPECT_NEAR(flight.velocity_mps(t_s).x(), 2.0 * t_s, 1e-9);
  }
}

TEST_F(TrajectoryTextTest, TakesAnglesFromTheColumns) {
  const Trajectory flight = read(
      "t_s,x_m,y_m,z_m,yaw_deg,roll_deg,pitch_deg\n"
      "0,0,0,1,170,10,-20\n"
      "1,1,3,1,-170,10,-20\n");
  const auto expected = [](double yaw_deg) -> Eigen::Matrix3d {
    return (Eigen::AngleAxisd(rad_from_deg(yaw_deg), Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(rad_from_deg(-20.0), Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(rad_from_deg(10.0), Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
  };
  EXPECT_LE((flight.T_map_body(0.0).linear() - expected(170.0)).norm(), 1e-9);
  EXPECT_LE((flight.T_map_body(0.5).linear() - expected(180.0)).norm(), 1e-6);
  EXPECT_LE((flight.T_map_body(1.0).linear() - expected(-170.0)).norm(), 1e-9);
}

TEST_F(TrajectoryTextTest, LevelsWhatIsMissingBesideAnAngle) {
  const Trajectory flight = read("t_s,x_m,y_m,z_m,pitch_deg\n0,0,0,1,30\n1,0,1,1,30\n2,0,4,1,30\n");
  const Eigen::Matrix3d expected =
      (Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(std::numbers::pi / 6.0, Eigen::Vector3d::UnitY()))
          .toRotationMatrix();
  EXPECT_LE((flight.T_map_body(1.3).linear() - expected).norm(), 1e-9);
}

TEST_F(TrajectoryTextTest, KeepsTheYawOfTheColumnAndTiltsWithTheThrust) {
  const Trajectory flight =
      read("t_s,x_m,y_m,z_m,yaw_deg\n0,0,0,1,90\n1,1,0,1,90\n2,4,0,1,90\n3,9,0,1,90\n");
  EXPECT_LE(
      (flight.T_map_body(1.5).linear() - thrust_attitude({2, 0, 0}, 0.5 * std::numbers::pi)).norm(),
      1e-9);
  // Speeding up to its right side: that side is down.
  EXPECT_LT(flight.T_map_body(1.5).linear().col(1).x(), -0.9);
  EXPECT_GT(flight.T_map_body(1.5).linear().col(1).z(), 0.1);
}

TEST_F(TrajectoryTextTest, StandsStillWhereTimedRowsRepeat) {
  const Trajectory flight = read("t_s,x_m,y_m,z_m\n0,1,2,3\n1,1,2,3\n2,1,2,3\n");
  EXPECT_LE(
      (flight.T_map_body(1.2).matrix() - make_pose(Eigen::Matrix3d::Identity(), {1, 2, 3}).matrix())
          .norm(),
      1e-12);
}

TEST_F(TrajectoryTextTest, TellsOfMissingFilesAndRows) {
  EXPECT_THAT(message_of([&] { (void)read_trajectory(folder.path() / "none.csv"); }),
              HasSubstr("none.csv: cannot be read"));
  EXPECT_THAT(message_of([&] { (void)read_trajectory(folder.path()); }),
              HasSubstr("cannot be read"));
  EXPECT_THAT(message(""), HasSubstr("has 0 rows"));
  EXPECT_THAT(message("# nothing\n"), HasSubstr("has 0 rows"));
  EXPECT_THAT(message("0 0 0 0 0 0 0 1\n"), HasSubstr("has 1 rows"));
  EXPECT_THAT(message("x_m,y_m,z_m\n1,2,3\n"), HasSubstr("has 1 rows"));
  EXPECT_THAT(message("x_m,y_m,z_m\n1,2,3\n1,2,3\n"), HasSubstr("1 waypoints that differ"));
}

TEST_F(TrajectoryTextTest, TellsOfWrongRowsOfTum) {
  const std::string row = "0 0 0 0 0 0 0 1\n";
  EXPECT_THAT(message(row + "1 0 0 0 0 0 1\n"), HasSubstr("flight.txt:2: found 7 values"));
  EXPECT_THAT(message(row + "# x\n1,0,0,0,0,0,0,1\n"), HasSubstr("flight.txt:3: found 1 values"));
  EXPECT_THAT(message(row + "1 0 abc 0 0 0 0 1\n"), HasSubstr("flight.txt:2: 'abc'"));
  EXPECT_THAT(message(row + "1 0 1.5x 0 0 0 0 1\n"), HasSubstr("flight.txt:2: '1.5x'"));
  EXPECT_THAT(message(row + "1 0 nan 0 0 0 0 1\n"), HasSubstr("flight.txt:2: 'nan'"));
  EXPECT_THAT(message("nan 0 0 0 0 0 0 1\n" + row), HasSubstr("flight.txt:1: 'nan'"));
  EXPECT_THAT(message(row + "1 0 -inf 0 0 0 0 1\n"), HasSubstr("flight.txt:2: '-inf'"));
  EXPECT_THAT(message(row + "1 0 1e999 0 0 0 0 1\n"), HasSubstr("flight.txt:2: '1e999'"));
  EXPECT_THAT(message(row + "1 0 1e7 0 0 0 0 1\n"), HasSubstr("flight.txt:2: a position"));
  EXPECT_THAT(message(row + "1 0 0 0 0 0 0 0\n"), HasSubstr("flight.txt:2: the quaternion"));
  EXPECT_THAT(message(row + "1 0 0 0 0 0 0 1e200\n"), HasSubstr("flight.txt:2: the quaternion"));
}

TEST_F(TrajectoryTextTest, TellsOfTimesThatDoNotIncrease) {
  const std::string row = "1 0 0 0 0 0 0 1\n";
  EXPECT_THAT(message(row + row), HasSubstr("flight.txt:2: time 1 s is not after"));
  EXPECT_THAT(message(row + "0.5 0 0 0 0 0 0 1\n"), HasSubstr("flight.txt:2: time 0.5 s"));
  EXPECT_THAT(message("-1e308 0 0 0 0 0 0 1\n1e308 0 0 0 0 0 0 1\n"), HasSubstr("flight.txt:2"));
  EXPECT_THAT(message("t_s,x_m,y_m,z_m\n0,1,2,3\n2,1,2,3\n1,1,2,3\n"),
              HasSubstr("flight.txt:4: time 1 s"));
  EXPECT_THAT(message("t_s,x_m,y_m,z_m\n0,1,2,3\n1e9,1,2,3\n"), HasSubstr("at most 3600"));
  EXPECT_THAT(message("0 1 2 3 0 0 0 1\n1e9 1 2 3 0 0 0 1\n"), HasSubstr("at most 3600"));
}

TEST_F(TrajectoryTextTest, TellsOfWrongHeaders) {
  EXPECT_THAT(message("x_m,y_m,z_m,speed\n1,2,3,4\n"),
              AllOf(HasSubstr("flight.txt:1: column 'speed' is unknown"), HasSubstr("yaw_deg")));
  EXPECT_THAT(message("# c\nx_m,y_m,x_m\n1,2,3\n"),
              HasSubstr("flight.txt:2: column 'x_m' is there twice"));
  EXPECT_THAT(message("x_m,y_m\n1,2\n3,4\n"), EndsWith("the header needs x_m, y_m and z_m"));
  EXPECT_THAT(message("x_m;y_m;z_m\n1;2;3\n"), HasSubstr("flight.txt:1: column"));
  EXPECT_THAT(message("x_m,y_m,z_m,yaw_deg\n1,2,3,4\n3,4,5,6\n"), HasSubstr("angles need t_s"));
  EXPECT_THAT(message("1,2,3\n4,5,6\n"), AllOf(HasSubstr("flight.txt:1"), HasSubstr("header")));
  EXPECT_THAT(message(std::string(500, 'x') + "\n"), HasSubstr("xxx...'"));
}

TEST_F(TrajectoryTextTest, TellsOfWrongRowsOfCsv) {
  const std::string head = "x_m,y_m,z_m\n1,2,3\n";
  EXPECT_THAT(message(head + "4,5\n"), HasSubstr("flight.txt:3: found 2 values, expected 3"));
  EXPECT_THAT(message(head + "4,5,6,\n"), HasSubstr("flight.txt:3: found 4 values"));
  EXPECT_THAT(message(head + "4,,6\n"), HasSubstr("flight.txt:3: '' is no finite number"));
  EXPECT_THAT(message(head + "4,0x5,6\n"), HasSubstr("flight.txt:3: '0x5'"));
  EXPECT_THAT(message(head + "4,5,1e300\n"), HasSubstr("flight.txt:3: a position"));
}

}  // namespace
}  // namespace skyhalo
