#include "skyhalo/io/epipolar_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace skyhalo {
namespace {

// In turn, so that a line is not taken for the next; none is a colour of matches.
const std::array<cv::Scalar, 3> kLineColours{
    cv::Scalar(120, 230, 120), cv::Scalar(220, 120, 240), cv::Scalar(220, 220, 60)};
const cv::Scalar kLevel(240, 140, 0);
const cv::Scalar kNearlyLevel(0, 230, 255);
const cv::Scalar kNotLevel(30, 30, 240);

constexpr std::size_t kMostJoined = 24;

/// Sizes of what is drawn: a picture of a wide pair is seen at a smaller scale.
struct Pen {
  explicit Pen(int width_px) : line_px(std::max(1, width_px / 1500)), font_scale(0.4 * line_px) {}

  int line_px;
  double font_scale;
};

cv::Scalar colour_of(const PairMatch& match) {
  const double apart_px = std::abs(match.dv_px);
  if (apart_px < 0.5) {
    return kLevel;
  }
  return apart_px < 1.0 ? kNearlyLevel : kNotLevel;
}

void draw_row(cv::Mat3b& picture, const Pen& pen, int row, const cv::Scalar& colour) {
  cv::line(picture, {0, row}, {picture.cols - 1, row}, colour, pen.line_px);
  const cv::Point place(2 * pen.line_px, row - 2 * pen.line_px);
  const std::string text = std::to_string(row);
  const int font = cv::FONT_HERSHEY_SIMPLEX;
  cv::putText(picture, text, place, font, pen.font_scale, {0, 0, 0}, 3 * pen.line_px, cv::LINE_AA);
  cv::putText(picture, text, place, font, pen.font_scale, colour, pen.line_px, cv::LINE_AA);
}

/// A match's two ends in the picture, in sixteenths of a pixel.
constexpr int kFractionBits = 4;

struct Ends {
  cv::Point left;
  cv::Point right;
};

Ends ends_of(const PairMatch& match, int left_width_px) {
  constexpr double kScale = 1 << kFractionBits;
  const cv::Point2d left = kScale * (match.right_px + cv::Point2d(match.disparity_px, match.dv_px));
  const cv::Point2d right = kScale * (match.right_px + cv::Point2d(left_width_px, 0.0));
  return {{cvRound(left.x), cvRound(left.y)}, {cvRound(right.x), cvRound(right.y)}};
}

void join(cv::Mat3b& picture, const Pen& pen, const Ends& ends, const cv::Scalar& colour) {
  cv::line(picture, ends.left, ends.right, colour, pen.line_px, cv::LINE_AA, kFractionBits);
}

void mark(cv::Mat3b& picture, const Pen& pen, const Ends& ends, const cv::Scalar& colour) {
  const int radius = (2 * pen.line_px) << kFractionBits;
  for (const cv::Point& end : {ends.left, ends.right}) {
    cv::circle(picture, end, radius, colour, cv::FILLED, cv::LINE_AA, kFractionBits);
  }
}

/// Matches from the top to the bottom.
std::vector<PairMatch> by_row(std::span<const PairMatch> matches) {
  std::vector<PairMatch> sorted(matches.begin(), matches.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const PairMatch& a, const PairMatch& b) {
    return a.right_px.y < b.right_px.y;
  });
  return sorted;
}

void draw_matches(cv::Mat3b& picture, const Pen& pen, std::span<const PairMatch> matches) {
  const int left_width_px = picture.cols / 2;
  const std::vector<PairMatch> sorted = by_row(matches);
  const std::size_t joined = std::min(sorted.size(), kMostJoined);
  for (std::size_t i = 0; i < joined; ++i) {
    const PairMatch& match = sorted[i * sorted.size() / joined];
    join(picture, pen, ends_of(match, left_width_px), colour_of(match));
  }
  for (const PairMatch& match : sorted) {
    mark(picture, pen, ends_of(match, left_width_px), colour_of(match));
  }
}

}  // namespace

cv::Mat3b epipolar_picture(const cv::Mat1b& left,
                           const cv::Mat1b& right,
                           int line_step_px,
                           std::span<const PairMatch> matches) {
  cv::Mat1b grey;
  cv::hconcat(left, right, grey);
  cv::Mat3b picture;
  cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
  const Pen pen(picture.cols);
  std::size_t count = 0;
  for (int row = line_step_px; line_step_px > 0 && row < picture.rows; row += line_step_px) {
    draw_row(picture, pen, row, kLineColours[count++ % kLineColours.size()]);
  }
  draw_matches(picture, pen, matches);
  return picture;
}

}  // namespace skyhalo
