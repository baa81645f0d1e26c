// The whole way from the raw images of a pair to depths and the map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "rectify/raw_scene.hpp"
#include "reference/naive_rectification.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/pipeline/obstacle_detector.hpp"
#include "support/expect_error.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

constexpr double kWallM = 3.0;  // straight ahead of the right camera, which sits in the body origin

/// Raw camera axes (x right, y down, z forward) to body axes.
Eigen::Matrix3d R_body_raw() {
  Eigen::Matrix3d R;
  R << 0, 0, 1,  //
      -1, 0, 0,  //
      0, -1, 0;
  return R;
}

/// What comes along a ray from a wall at a distance along the raw right camera's z.
class TexturedWall {
 public:
  TexturedWall() {
    cv::GaussianBlur(testing::texture({1024, 1024}, 5), texture_, {}, 0.8);
    cv::normalize(texture_, texture_, 0, 255, cv::NORM_MINMAX);
  }

  double operator()(const Eigen::Vector3d& from_m, const Eigen::Vector3d& ray) const {
    constexpr double kTexelsPerM = 50.0;
    const double range_m = (kWallM - from_m.z()) / ray.z();
    const Eigen::Vector3d at =
        512.0 * Eigen::Vector3d::Ones() + kTexelsPerM * (from_m + range_m * ray);
    const bool meets = ray.z() > 0.01;
    return meets ? reference::naive_bilinear(texture_, {at.x(), at.y()}).value_or(90.0) : 90.0;
  }

 private:
  cv::Mat1b texture_;
};

/// A pair of fisheyes, and what it sees of the wall.
struct Example {
  RawPair raw;
  StereoPair pair;
  StereoImages images;
};

Example example_of(const testing::ExampleLens& lens, const VirtualPairWish& wish) {
  testing::RandomRays random(21);
  Example example{.raw = testing::turned_pair(lens, lens, random), .pair = {}, .images = {}};
  example.pair = testing::stereo_pair(example.raw, wish);
  // p_body = R_body_raw * R_raw_cam * p_cam.
  example.pair.T_body_camera =
      make_pose(R_body_raw() * example.pair.raw->R_right_cam, Eigen::Vector3d::Zero());
  example.images = testing::render_pair(example.raw, TexturedWall());
  return example;
}

const Example& pinhole_example() {
  static const Example example = example_of(testing::kannala_brandt_examples()[0],
                                            {.model = PairModelKind::kPinhole,
                                             .hfov_rad = rad_from_deg(80.0),
                                             .size_px = cv::Size(640, 400)});
  return example;
}

const Example& spherical_example() {
  static const Example example = example_of(testing::ideal_fisheye(175.0),
                                            {.model = PairModelKind::kSpherical,
                                             .hfov_rad = rad_from_deg(140.0),
                                             .vfov_rad = rad_from_deg(70.0),
                                             .size_px = cv::Size(1024, 512)});
  return example;
}

DetectorConfig config_of() {
  DetectorConfig config;
  config.matching.downscale = 2;
  config.matching.rcrop_px = 32;
  config.matching.matcher.max_disparity_px = 48;
  config.sphere.bounds.phi_min_rad = rad_from_deg(-90.0);
  config.sphere.bounds.phi_max_rad = rad_from_deg(90.0);
  config.sensor_model.delta_d_px = 0.1;
  return config;
}

ObstacleDetector detector_of(const StereoPair& pair, const DetectorConfig& config = config_of()) {
  return {{{pair}},
          config,
          make_voxel_grid({Eigen::Vector3d(-1.25, -6.25, -4.25), Eigen::Vector3d(8.75, 6.25, 4.25)},
                          0.5)};
}

/// A detector that has seen the wall.
ObstacleDetector seen(const Example& example, const DetectorConfig& config = config_of()) {
  ObstacleDetector detector = detector_of(example.pair, config);
  detector.process({.stamp = {}, .pairs = {example.images}}, Pose::Identity());
  return detector;
}

/// Relative errors of the cells' mean ranges against the wall's along the cells' middles, for the
/// cells of many points, sorted.
std::vector<double> errors_of(const SphericalGrid& grid) {
  std::vector<double> errors;
  for (int i = 0; i < grid.geometry().cell_count(); ++i) {
    const GridCell at{i / grid.geometry().cols, i % grid.geometry().cols};
    const std::optional<CellStatistics> cell = grid.statistics(at);
    if (cell && cell->count >= 4) {
      const double true_m = kWallM / grid.geometry().center_direction(at).x();
      errors.push_back(std::abs(cell->mean_m / true_m - 1.0));
    }
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

void expect_wall(const Example& example, double half_width_m) {
  const ObstacleDetector detector = seen(example);
  const std::vector<double> errors = errors_of(detector.perception(0).grid);
  ASSERT_GT(errors.size(), 1500U);
  // A tenth of a pixel of about 20 is half a per cent.
  EXPECT_LT(errors[errors.size() / 2], 0.005);
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.03);
  for (double y = -half_width_m; y <= half_width_m; y += 0.5) {
    for (double z = -1.0; z <= 1.0; z += 0.5) {
      // The cells are centred on multiples of half a metre, so also on the wall.
      EXPECT_GT(probability_of(detector.dense_map().at_point({kWallM, y, z})), 0.7)
          << y << ", " << z;
      EXPECT_LT(detector.dense_map().at_point({0.5 * kWallM, 0.5 * y, 0.5 * z}), 0)
          << y << ", " << z;
      EXPECT_EQ(detector.dense_map().at_point({kWallM + 2.5, y, z}), kUnknown) << y << ", " << z;
    }
  }
}

TEST(RawPairSystem, AWallSeenByFisheyesIsWhereItIsByThePinholeModel) {
  expect_wall(pinhole_example(), 1.5);
}

TEST(RawPairSystem, AWallSeenByFisheyesIsWhereItIsByTheSphericalModel) {
  expect_wall(spherical_example(), 4.0);
}

/// How many pixels have a disparity where one of the cameras cannot have seen anything; `outside`
/// counts the pixels that the right one cannot.
struct Unseen {
  int outside = 0;
  int with_disparity = 0;
};

Unseen count_unseen(const Example& example, const cv::Mat1f& disparity, double max_rad) {
  Unseen count;
  const PairModel model = downscaled(example.pair.model, 2);
  const auto angle_rad = [&](const Eigen::Matrix3d& R_raw_cam, double u, double v) {
    return std::acos((R_raw_cam * ray_of(model, u, v)).z());
  };
  for (int v = 0; v < disparity.rows; ++v) {
    for (int u = 0; u < disparity.cols; ++u) {
      const float d = disparity(v, u);
      const bool right = angle_rad(example.pair.raw->R_right_cam, u, v) <= max_rad;
      const bool left = std::isnan(d) || angle_rad(example.pair.raw->R_left_cam,
                                                   std::round(u + static_cast<double>(d)),
                                                   v) <= max_rad;
      count.outside += right ? 0 : 1;
      count.with_disparity += !std::isnan(d) && !(right && left) ? 1 : 0;
    }
  }
  return count;
}

TEST(RawPairSystem, NothingIsMeasuredOutsideTheImageCircle) {
  // r = theta - 0.3 theta^3 grows up to 60.4 degrees, 257 px: there the image ends. Beyond, both
  // raw images show one and the same texture.
  const testing::ExampleLens lens{
      "image circle", KannalaBrandtLens({366.0, 366.0, 375.5, 299.5}, {-0.3, 0, 0, 0}), {752, 600}};
  Example example = example_of(lens,
                               {.model = PairModelKind::kSpherical,
                                .hfov_rad = rad_from_deg(100.0),
                                .vfov_rad = rad_from_deg(100.0),
                                .size_px = cv::Size(640, 640)});
  // The same pair with wider margins.
  example.pair.image_size_px += cv::Size(192, 160);
  std::get<SphericalPair>(example.pair.model).principal_u_px += 96.0;
  std::get<SphericalPair>(example.pair.model).principal_v_px += 80.0;
  const cv::Mat1b noise = testing::texture(lens.size_px, 6);
  for (cv::Mat* const image : {&example.images.left, &example.images.right}) {
    cv::Mat1b circle(lens.size_px, uchar{0});
    cv::circle(circle, {376, 300}, 254, 255, cv::FILLED);
    cv::Mat framed = noise.clone();
    image->copyTo(framed, circle);
    *image = framed;
  }
  const ObstacleDetector detector = seen(example);
  const cv::Mat1f& disparity = detector.perception(0).disparity;
  const Unseen count = count_unseen(example, disparity, max_angle_rad(lens.lens));
  EXPECT_GT(count.outside, disparity.size().area() / 4);
  EXPECT_EQ(count.with_disparity, 0);
  EXPECT_GT(detector.perception(0).pixels.measured, disparity.size().area() / 8);
}

TEST(RawPairTest, ThePairsDownscaleWins) {
  Example example = pinhole_example();
  EXPECT_EQ(seen(example).perception(0).disparity.size(), cv::Size(320, 200));
  example.pair.downscale = 4;
  const ObstacleDetector detector = seen(example);
  EXPECT_EQ(detector.perception(0).disparity.size(), cv::Size(160, 100));
  const std::vector<double> errors = errors_of(detector.perception(0).grid);
  ASSERT_GT(errors.size(), 200U);
  // A fifth of a pixel of about 9.
  EXPECT_LT(errors[errors.size() / 2], 0.022);
}

/// The right-most column with a disparity, counted from the right.
int crop_of(const cv::Mat1f& disparity) {
  for (int u = disparity.cols - 1; u >= 0; --u) {
    if (cv::countNonZero(disparity.col(u) == disparity.col(u)) > 0) {
      return disparity.cols - 1 - u;
    }
  }
  return disparity.cols;
}

TEST(RawPairTest, ThePairsCropWins) {
  Example example = pinhole_example();
  example.pair.rcrop_px = 100;
  EXPECT_EQ(crop_of(seen(example).perception(0).disparity), 100);
  example.pair.rcrop_px = 60;
  DetectorConfig config = config_of();
  config.matching.rcrop_px = 120;
  EXPECT_EQ(crop_of(seen(example, config).perception(0).disparity), 60);
  example.pair.rcrop_px.reset();
  EXPECT_EQ(crop_of(seen(example, config).perception(0).disparity), 120);
}

/// The nearest and the farthest point that went into the grid (m).
std::pair<double, double> reach_of(const SphericalGrid& grid) {
  std::pair<double, double> reach(std::numeric_limits<double>::infinity(), 0.0);
  for (int i = 0; i < grid.geometry().cell_count(); ++i) {
    if (const auto cell = grid.statistics({i / grid.geometry().cols, i % grid.geometry().cols})) {
      reach = {std::min(reach.first, cell->min_m), std::max(reach.second, cell->mean_m)};
    }
  }
  return reach;
}

TEST(RawPairTest, ThePairsRangesWin) {
  Example example = pinhole_example();
  DetectorConfig config = config_of();
  config.sphere.max_range_m = 2.0;
  EXPECT_LT(reach_of(seen(example, config).perception(0).grid).second, 2.0);
  example.pair.max_range_m = 3.5;
  const auto wider = reach_of(seen(example, config).perception(0).grid);
  EXPECT_GT(wider.second, 3.2);
  EXPECT_LE(wider.second, 3.5);
  example.pair.min_range_m = 3.2;
  const ObstacleDetector detector = seen(example, config);
  const auto between = reach_of(detector.perception(0).grid);
  EXPECT_GE(between.first, 3.2);
  EXPECT_LE(between.second, 3.5);
  EXPECT_GT(detector.perception(0).pixels.used, 1000);
  EXPECT_GT(detector.perception(0).pixels.measured, detector.perception(0).pixels.used);
}

TEST(RawPairTest, RefusesImagesThatAreNotOfTheRawSizeAndKeepsTheMap) {
  const Example& example = pinhole_example();
  ObstacleDetector detector = seen(example);
  const std::vector<LogOdds> before(detector.dense_map().cells().begin(),
                                    detector.dense_map().cells().end());
  const auto refusal = [&](const cv::Mat& left, const cv::Mat& right) {
    return message_of([&] {
      detector.process({.stamp = {}, .pairs = {{left, right}}}, Pose::Identity());
    });
  };
  const cv::Mat rectified = testing::texture(example.pair.image_size_px, 7);
  EXPECT_THAT(refusal(rectified, rectified), HasSubstr("pair front"));
  EXPECT_THAT(refusal(example.images.left, rectified), HasSubstr("pair front"));
  EXPECT_THAT(refusal(rectified, example.images.right), HasSubstr("pair front"));
  EXPECT_THAT(refusal({}, example.images.right), HasSubstr("pair front"));
  EXPECT_EQ(std::vector<LogOdds>(detector.dense_map().cells().begin(),
                                 detector.dense_map().cells().end()),
            before);
}

}  // namespace
}  // namespace skyhalo
