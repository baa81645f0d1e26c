#include "skyhalo/evaluation/row_difference.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace skyhalo {
namespace {

constexpr float kDetectorThreshold = 1e-4F;
constexpr int kOctaves = 2;
constexpr int kEdgePx = 12;
constexpr std::size_t kCellsAcross = 8;
constexpr std::size_t kCellsDown = 6;
constexpr std::size_t kFeaturesPerCell = 32;
constexpr float kRatio = 0.8F;
constexpr double kMaxRowsApart = 16.0;
constexpr double kInlierPx = 2.0;
constexpr int kTrials = 500;
constexpr std::size_t kFewestForAPlane = 3;
constexpr double kNegativeDisparityPx = -1.0;

struct Features {
  std::vector<cv::KeyPoint> points;
  cv::Mat descriptors;
};

/// Where features may lie: valid, and far enough from what is not, the image's border included.
cv::Mat1b inner_part(const cv::Mat1b& valid, const cv::Size& size) {
  cv::Mat1b inner(size, 0);
  const cv::Rect frame = cv::Rect({}, size) & cv::Rect(kEdgePx,
                                                       kEdgePx,
                                                       std::max(0, size.width - 2 * kEdgePx),
                                                       std::max(0, size.height - 2 * kEdgePx));
  inner(frame) = 255;
  if (!valid.empty()) {
    const int side = 2 * kEdgePx + 1;
    cv::Mat1b eroded;
    cv::erode(valid, eroded, cv::Mat1b::ones(side, side));
    inner &= eroded;
  }
  return inner;
}

/// The strongest features of every part of the image, so that matches come from everywhere and
/// their number stays limited.
std::vector<int> strongest(const std::vector<cv::KeyPoint>& points, const cv::Size& size) {
  std::vector<int> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = static_cast<int>(i);
  }
  const auto at = [&](int i) -> const cv::KeyPoint& { return points[static_cast<std::size_t>(i)]; };
  std::stable_sort(
      order.begin(), order.end(), [&](int a, int b) { return at(a).response > at(b).response; });
  std::vector<std::size_t> taken(kCellsAcross * kCellsDown, 0);
  const auto cell_of = [](float at_px, int length_px, std::size_t cells) {
    const auto cell = static_cast<std::size_t>(static_cast<double>(cells) * at_px / length_px);
    return std::min(cell, cells - 1);
  };
  std::erase_if(order, [&](int i) {
    const std::size_t column = cell_of(at(i).pt.x, size.width, kCellsAcross);
    const std::size_t row = cell_of(at(i).pt.y, size.height, kCellsDown);
    return ++taken[row * kCellsAcross + column] > kFeaturesPerCell;
  });
  return order;
}

Features find_features(const cv::Mat1b& image, const cv::Mat1b& valid) {
  const cv::Mat1b where = inner_part(valid, image.size());
  if (cv::countNonZero(where) == 0) {
    return {};  // also for images that are too small for the detector
  }
  const auto detector =
      cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB, 0, 3, kDetectorThreshold, kOctaves);
  Features all;
  detector->detectAndCompute(image, where, all.points, all.descriptors);
  Features kept;
  for (const int i : strongest(all.points, image.size())) {
    kept.points.push_back(all.points[static_cast<std::size_t>(i)]);
    kept.descriptors.push_back(all.descriptors.row(i));
  }
  return kept;
}

std::vector<PairMatch> match(const Features& left, const Features& right) {
  if (left.points.size() < 2 || right.points.size() < 2) {
    return {};
  }
  const cv::BFMatcher matcher(cv::NORM_HAMMING);
  std::vector<std::vector<cv::DMatch>> to_left;
  std::vector<cv::DMatch> to_right;
  matcher.knnMatch(right.descriptors, left.descriptors, to_left, 2);
  matcher.match(left.descriptors, right.descriptors, to_right);
  std::vector<PairMatch> matches;
  for (const std::vector<cv::DMatch>& nearest : to_left) {
    const cv::DMatch& best = nearest[0];
    if (best.distance >= kRatio * nearest[1].distance ||
        to_right[static_cast<std::size_t>(best.trainIdx)].trainIdx != best.queryIdx) {
      continue;
    }
    const cv::Point2d at_left = left.points[static_cast<std::size_t>(best.trainIdx)].pt;
    const cv::Point2d at_right = right.points[static_cast<std::size_t>(best.queryIdx)].pt;
    if (std::abs(at_left.y - at_right.y) <= kMaxRowsApart) {
      matches.push_back({at_right, at_left.x - at_right.x, at_left.y - at_right.y});
    }
  }
  return matches;
}

/// (1, u, v): its product with (a, b, c) is a plane's dv.
Eigen::Vector3d place(const PairMatch& match) {
  return {1.0, match.right_px.x, match.right_px.y};
}

std::vector<PairMatch> near_plane(const std::vector<PairMatch>& matches,
                                  const Eigen::Vector3d& plane) {
  std::vector<PairMatch> near;
  std::copy_if(matches.begin(), matches.end(), std::back_inserter(near), [&](const PairMatch& m) {
    return std::abs(m.dv_px - plane.dot(place(m))) <= kInlierPx;
  });
  return near;
}

/// The plane through three matches; none when they lie on a line.
std::optional<Eigen::Vector3d> plane_through(const std::array<const PairMatch*, 3>& matches) {
  Eigen::Matrix3d places;
  Eigen::Vector3d dv_px;
  for (int i = 0; i < 3; ++i) {
    places.row(i) = place(*matches[static_cast<std::size_t>(i)]);
    dv_px[i] = matches[static_cast<std::size_t>(i)]->dv_px;
  }
  // The determinant is twice the triangle's area in pixels.
  if (std::abs(places.determinant()) < 100.0) {
    return std::nullopt;
  }
  return Eigen::Vector3d(places.inverse() * dv_px);
}

std::vector<PairMatch> without_wrong_ones(const std::vector<PairMatch>& matches) {
  std::vector<PairMatch> best;
  if (matches.size() < kFewestForAPlane) {
    return best;
  }
  cv::RNG random(20240229);
  const auto pick = [&] {
    return &matches[static_cast<std::size_t>(random.uniform(0, static_cast<int>(matches.size())))];
  };
  for (int trial = 0; trial < kTrials; ++trial) {
    if (const auto plane = plane_through({pick(), pick(), pick()})) {
      std::vector<PairMatch> near = near_plane(matches, *plane);
      if (near.size() > best.size()) {
        best = std::move(near);
      }
    }
  }
  return best;
}

/// The value that a share of the values does not exceed, between neighbours in proportion; NaN
/// without values.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  std::sort(values.begin(), values.end());
  const double position = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], position - static_cast<double>(below));
}

template <class Value>
std::vector<double> collect(const std::vector<PairMatch>& matches, Value value_of) {
  std::vector<double> values;
  std::transform(matches.begin(), matches.end(), std::back_inserter(values), value_of);
  return values;
}

}  // namespace

RowDifference row_difference(const cv::Mat1b& left,
                             const cv::Mat1b& right,
                             const cv::Mat1b& left_valid,
                             const cv::Mat1b& right_valid) {
  RowDifference result;
  result.inliers =
      without_wrong_ones(match(find_features(left, left_valid), find_features(right, right_valid)));
  result.matches = static_cast<int>(result.inliers.size());
  const auto dv_px = collect(result.inliers, [](const PairMatch& m) { return m.dv_px; });
  const auto abs_dv_px =
      collect(result.inliers, [](const PairMatch& m) { return std::abs(m.dv_px); });
  const auto disparity_px =
      collect(result.inliers, [](const PairMatch& m) { return m.disparity_px; });
  result.median_dv_px = quantile(dv_px, 0.5);
  result.median_abs_dv_px = quantile(abs_dv_px, 0.5);
  result.p90_abs_dv_px = quantile(abs_dv_px, 0.9);
  result.median_disparity_px = quantile(disparity_px, 0.5);
  const auto negative = std::count_if(
      disparity_px.begin(), disparity_px.end(), [](double d) { return d < kNegativeDisparityPx; });
  result.negative_disparity_share =
      static_cast<double>(negative) / static_cast<double>(disparity_px.size());  // NaN for 0 / 0
  return result;
}

}  // namespace skyhalo
