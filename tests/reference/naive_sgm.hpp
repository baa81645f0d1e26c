#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace skyhalo::reference {

/// Settings of the matcher. Names ending in _64 are in 1/64 px, p1 and p2 in units of the cost.
struct NaiveSgmSettings {
  int max_disparity_px = 64;   // D: disparities 0 to D - 1 are searched
  int p1 = 4;                  // penalty of a step of one disparity
  int p2_max = 48;             // penalty of a larger step where the image is flat
  int p2_min = 7;              // the least penalty of a larger step, at strong image edges
  int uniqueness_percent = 2;  // the winner is better than the second by more than this
  int left_right_64 = 64;      // largest difference of the two directions
  int texture_min = 2;         // least grey level range of the 9x9 window
  int repetition_px = 76;      // pixels of 9x9 that look repeated from which there is no match
  int fill_min = 11;           // valid pixels in 5x5 from which an invalid pixel is filled
  int median_passes = 3;
  int speckle_size_px = 200;  // components with fewer pixels are dropped; 0 drops none
  int speckle_step_64 = 48;   // largest difference of linked neighbours
  int edge_step_64 = 192;     // largest difference to a neighbour; 0 skips the step
  bool align_left = false;    // the result is aligned with the left image instead of the right
};

/// Disparity in the images of 1/64 px where there is no match.
inline constexpr std::int16_t kNoDisparity64 = -1;

/// One number per pixel and disparity: x in [0, width_px), y in [0, height_px), d in
/// [0, disparities_px). Costs, path costs and their sums.
struct Volume {
  int width_px = 0;
  int height_px = 0;
  int disparities_px = 0;
  std::vector<int> values;

  [[nodiscard]] std::size_t index(int x, int y, int d) const {
    const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
                              static_cast<std::size_t>(x);
    return pixel * static_cast<std::size_t>(disparities_px) + static_cast<std::size_t>(d);
  }

  int& at(int x, int y, int d) { return values[index(x, y, d)]; }

  [[nodiscard]] int at(int x, int y, int d) const { return values[index(x, y, d)]; }

  [[nodiscard]] bool contains(int x, int y) const {
    return x >= 0 && x < width_px && y >= 0 && y < height_px;
  }
};

/// A pixel, or the displacement from one pixel to another.
struct Pixel {
  int x = 0;
  int y = 0;
};

/// Volume of the given size filled with zeros.
inline Volume zero_volume(int width_px, int height_px, int disparities_px) {
  Volume volume;
  volume.width_px = width_px;
  volume.height_px = height_px;
  volume.disparities_px = disparities_px;
  volume.values.resize(volume.index(0, height_px, 0), 0);
  return volume;
}

/// Grey level at (x, y); coordinates outside the image are clamped to the border.
inline int clamped(const cv::Mat1b& image, int x, int y) {
  return image(std::clamp(y, 0, image.rows - 1), std::clamp(x, 0, image.cols - 1));
}

/// Mean of two non-negative grey levels, halves rounded up.
inline int average(int a, int b) {
  return (a + b + 1) >> 1;
}

/// Mean of the centre (weight 1/2) and its four neighbours (1/8 each), rounded at each mean of
/// two. First pre-filter of the wider census rings.
inline cv::Mat1b cross_smoothed(const cv::Mat1b& image) {
  cv::Mat1b result(image.rows, image.cols);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const int north_south = average(clamped(image, x, y - 1), clamped(image, x, y + 1));
      const int west_east = average(clamped(image, x - 1, y), clamped(image, x + 1, y));
      const int neighbours = average(north_south, west_east);
      result(y, x) = static_cast<std::uint8_t>(average(image(y, x), neighbours));
    }
  }
  return result;
}

/// Weights 1/4, 1/2, 1/4 along the row and then, on that image, along the column, rounded at each
/// mean of two. Second pre-filter of the wider census rings.
inline cv::Mat1b box_smoothed(const cv::Mat1b& image) {
  cv::Mat1b rows_smoothed(image.rows, image.cols);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const int west_east = average(clamped(image, x - 1, y), clamped(image, x + 1, y));
      rows_smoothed(y, x) = static_cast<std::uint8_t>(average(image(y, x), west_east));
    }
  }
  cv::Mat1b result(image.rows, image.cols);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const int north_south =
          average(clamped(rows_smoothed, x, y - 1), clamped(rows_smoothed, x, y + 1));
      result(y, x) = static_cast<std::uint8_t>(average(rows_smoothed(y, x), north_south));
    }
  }
  return result;
}

/// Median of the 3x3 neighbourhood, clamped to the border.
inline cv::Mat1b median3(const cv::Mat1b& image) {
  cv::Mat1b result(image.rows, image.cols);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      std::vector<int> levels;
      levels.reserve(9);
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          levels.push_back(clamped(image, x + dx, y + dy));
        }
      }
      std::sort(levels.begin(), levels.end());
      result(y, x) = static_cast<std::uint8_t>(levels[4]);
    }
  }
  return result;
}

/// Census of one ring (Zabih and Woodfill 1994): bit k is 1 where the k-th of the eight neighbours
/// at `radius_px`, row by row, is darker than the centre. Clamped to the border.
inline int census_ring(const cv::Mat1b& image, int x, int y, int radius_px) {
  constexpr std::array<Pixel, 8> kNeighbours{
      {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
  int bits = 0;
  int bit = 1;
  for (const Pixel& offset : kNeighbours) {
    const int neighbour = clamped(image, x + radius_px * offset.x, y + radius_px * offset.y);
    if (neighbour < image(y, x)) {
      bits += bit;
    }
    bit *= 2;
  }
  return bits;
}

/// Census of 24 bits (Zabih and Woodfill 1994): bits 0-7 the ring of radius 1 of the raw image,
/// bits 8-15 radius 2 of the cross-smoothed one, bits 16-23 radius 4 of the box-smoothed one.
inline cv::Mat1i census(const cv::Mat1b& image) {
  const cv::Mat1b cross = cross_smoothed(image);
  const cv::Mat1b box = box_smoothed(image);
  cv::Mat1i result(image.rows, image.cols);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      result(y, x) = census_ring(image, x, y, 1) + 256 * census_ring(cross, x, y, 2) +
                     65536 * census_ring(box, x, y, 4);
    }
  }
  return result;
}

/// Number of census bits in which two pixels differ.
inline int hamming_distance(int census_a, int census_b) {
  return std::popcount(static_cast<unsigned>(census_a) ^ static_cast<unsigned>(census_b));
}

/// Cost C of right pixel (x, y) against left pixel (x + d, y): half the Hamming distance of the
/// census, rounded up (0 to 12); 6 where the left pixel is outside the image. Both of one size.
inline Volume matching_cost(const cv::Mat1b& left, const cv::Mat1b& right, int disparities_px) {
  constexpr int kOutsideCost = 6;
  const cv::Mat1i left_census = census(left);
  const cv::Mat1i right_census = census(right);
  Volume cost = zero_volume(right.cols, right.rows, disparities_px);
  for (int y = 0; y < right.rows; ++y) {
    for (int x = 0; x < right.cols; ++x) {
      for (int d = 0; d < disparities_px; ++d) {
        if (x + d < right.cols) {
          const int distance = hamming_distance(right_census(y, x), left_census(y, x + d));
          cost.at(x, y, d) = (distance + 1) / 2;
        } else {
          cost.at(x, y, d) = kOutsideCost;
        }
      }
    }
  }
  return cost;
}

/// Penalty P2 between two neighbours whose median-filtered grey levels are given: falls by 7/4 per
/// grey level of difference, never below p2_min (the adaptive P2 of Hirschmueller 2008, cost
/// aggregation).
inline int large_step_penalty(int level, int previous_level, const NaiveSgmSettings& settings) {
  const int gradient = std::abs(level - previous_level);
  return std::max(settings.p2_min, settings.p2_max - (gradient + gradient / 2 + gradient / 4));
}

/// Least value of a pixel over all disparities.
inline int least(const Volume& volume, int x, int y) {
  int result = volume.at(x, y, 0);
  for (int d = 1; d < volume.disparities_px; ++d) {
    result = std::min(result, volume.at(x, y, d));
  }
  return result;
}

/// Turns the costs C(pixel, .) held in `path` into the path costs L_r(pixel, .), given those of the
/// predecessor pixel - r, which lies inside the image (Hirschmueller 2008, cost aggregation).
inline void extend_path(Volume& path, Pixel pixel, Pixel predecessor, int p1, int p2) {
  const int predecessor_least = least(path, predecessor.x, predecessor.y);
  for (int d = 0; d < path.disparities_px; ++d) {
    int best = path.at(predecessor.x, predecessor.y, d);
    if (d > 0) {
      best = std::min(best, path.at(predecessor.x, predecessor.y, d - 1) + p1);
    }
    if (d + 1 < path.disparities_px) {
      best = std::min(best, path.at(predecessor.x, predecessor.y, d + 1) + p1);
    }
    best = std::min(best, predecessor_least + p2);
    path.at(pixel.x, pixel.y, d) += best - predecessor_least;
  }
}

/// Path costs L_r of all pixels for one direction; `backwards` is -r, the displacement to the
/// predecessor. A pixel without a predecessor keeps its cost: L_r = C (Hirschmueller 2008, cost
/// aggregation). `guide` is the median-filtered image that steers P2.
inline Volume path_costs(const Volume& cost,
                         const cv::Mat1b& guide,
                         Pixel backwards,
                         const NaiveSgmSettings& settings) {
  Volume path = cost;
  const bool raster_order = backwards.y < 0 || (backwards.y == 0 && backwards.x < 0);
  const int pixel_count = cost.width_px * cost.height_px;
  for (int i = 0; i < pixel_count; ++i) {
    const int pixel_index = raster_order ? i : pixel_count - 1 - i;
    const int x = pixel_index % cost.width_px;
    const int y = pixel_index / cost.width_px;
    const Pixel predecessor{x + backwards.x, y + backwards.y};
    if (cost.contains(predecessor.x, predecessor.y)) {
      const int p2 = large_step_penalty(guide(y, x), guide(predecessor.y, predecessor.x), settings);
      extend_path(path, Pixel{x, y}, predecessor, settings.p1, p2);
    }
  }
  return path;
}

/// Sum of the path costs of four directions, half of those of Hirschmueller 2008 (cost
/// aggregation), each given by the displacement to its predecessors.
inline Volume path_sum(const Volume& cost,
                       const cv::Mat1b& guide,
                       const std::array<Pixel, 4>& directions,
                       const NaiveSgmSettings& settings) {
  Volume sum = zero_volume(cost.width_px, cost.height_px, cost.disparities_px);
  for (const Pixel& backwards : directions) {
    const Volume path = path_costs(cost, guide, backwards, settings);
    for (std::size_t i = 0; i < sum.values.size(); ++i) {
      sum.values[i] += path.values[i];
    }
  }
  return sum;
}

/// Sum F of the four paths that come from the left and from above.
inline Volume forward_sum(const Volume& cost,
                          const cv::Mat1b& right,
                          const NaiveSgmSettings& settings) {
  return path_sum(cost, median3(right), {{{-1, 0}, {0, -1}, {-1, -1}, {1, -1}}}, settings);
}

/// Sum B of the four paths that come from the right and from below.
inline Volume backward_sum(const Volume& cost,
                           const cv::Mat1b& right,
                           const NaiveSgmSettings& settings) {
  return path_sum(cost, median3(right), {{{1, 0}, {0, 1}, {1, 1}, {-1, 1}}}, settings);
}

/// Aggregated cost S: half the sum of the eight path costs, rounded up (Hirschmueller 2008, cost
/// aggregation).
inline Volume aggregate(const Volume& cost,
                        const cv::Mat1b& right,
                        const NaiveSgmSettings& settings) {
  Volume result = forward_sum(cost, right, settings);
  const Volume backward = backward_sum(cost, right, settings);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    result.values[i] = (result.values[i] + backward.values[i] + 1) >> 1;
  }
  return result;
}

/// Winner of right pixel (x, y): the smallest d that minimises S(x, y, d), also where x + d is
/// outside the left image (winner takes all, Hirschmueller 2008, disparity computation).
inline int best_disparity(const Volume& sums, int x, int y) {
  int best = 0;
  for (int d = 1; d < sums.disparities_px; ++d) {
    if (sums.at(x, y, d) < sums.at(x, y, best)) {
      best = d;
    }
  }
  return best;
}

/// Winner of left pixel (left_x, y), read off the same sums along the diagonal S(left_x - d, y, d)
/// inside the right image (Hirschmueller 2008, disparity computation). The smallest d of equals.
inline int best_left_disparity(const Volume& sums, int left_x, int y) {
  int best = 0;
  for (int d = 1; d < sums.disparities_px && d <= left_x; ++d) {
    if (sums.at(left_x - d, y, d) < sums.at(left_x - best, y, best)) {
      best = d;
    }
  }
  return best;
}

/// Whether the winner is better by more than uniqueness_percent than every disparity that is not
/// next to it. False where there is no such disparity to compare with.
inline bool is_unique(const Volume& sums, int x, int y, int best, int uniqueness_percent) {
  int second = 0;  // no sum is below 0, so nothing is better than this
  bool found = false;
  for (int d = 0; d < sums.disparities_px; ++d) {
    if (std::abs(d - best) > 1 && (!found || sums.at(x, y, d) < second)) {
      second = sums.at(x, y, d);
      found = true;
    }
  }
  return 100 * sums.at(x, y, best) < (100 - uniqueness_percent) * second;
}

/// Winner in 1/64 px at the bottom of the V through the sums at best - 1, best and best + 1, whose
/// two arms are equally steep (the steeper side gives the slope), rounded to the nearest integer,
/// ties to even. The whole disparity at either end of the range and where neither neighbour is
/// larger.
inline int refined_64(const Volume& sums, int x, int y, int best) {
  if (best == 0 || best == sums.disparities_px - 1) {
    return 64 * best;
  }
  const int before = sums.at(x, y, best - 1);
  const int after = sums.at(x, y, best + 1);
  const int height = std::max(before, after) - sums.at(x, y, best);
  if (height <= 0) {
    return 64 * best;
  }
  const float offset_64 = static_cast<float>(32 * (before - after)) / static_cast<float>(height);
  return 64 * best + static_cast<int>(std::nearbyint(offset_64));
}

/// Difference between the brightest and the darkest grey level in the 9x9 window, clamped to the
/// border.
inline int texture(const cv::Mat1b& image, int x, int y) {
  int darkest = image(y, x);
  int brightest = image(y, x);
  for (int dy = -4; dy <= 4; ++dy) {
    for (int dx = -4; dx <= 4; ++dx) {
      const int level = clamped(image, x + dx, y + dy);
      darkest = std::min(darkest, level);
      brightest = std::max(brightest, level);
    }
  }
  return brightest - darkest;
}

/// Number of runs of consecutive disparities at which pixel (x, y) matches almost perfectly, with a
/// cost of at most 1.
inline int good_runs(const Volume& cost, int x, int y) {
  constexpr int kGoodCost = 1;
  int runs = 0;
  for (int d = 0; d < cost.disparities_px; ++d) {
    if (cost.at(x, y, d) <= kGoodCost && (d == 0 || cost.at(x, y, d - 1) > kGoodCost)) {
      ++runs;
    }
  }
  return runs;
}

/// 1 where the matching cost has at least three good runs, as on a repeated pattern, else 0.
inline cv::Mat1b looks_repeated(const Volume& cost) {
  constexpr int kRepeatedRuns = 3;
  cv::Mat1b result(cost.height_px, cost.width_px);
  for (int y = 0; y < cost.height_px; ++y) {
    for (int x = 0; x < cost.width_px; ++x) {
      result(y, x) = good_runs(cost, x, y) >= kRepeatedRuns ? 1 : 0;
    }
  }
  return result;
}

/// Whether at least repetition_px of the 81 pixels of the 9x9 window, clamped to the border, are 1
/// in `repeated`.
inline bool is_ambiguous(const cv::Mat1b& repeated, int x, int y, int repetition_px) {
  int count = 0;
  for (int dy = -4; dy <= 4; ++dy) {
    for (int dx = -4; dx <= 4; ++dx) {
      count += clamped(repeated, x + dx, y + dy);
    }
  }
  return count >= repetition_px;
}

/// 1 where the raw right image has enough texture and is not ambiguous, else 0.
inline cv::Mat1b confident(const Volume& cost,
                           const cv::Mat1b& right,
                           const NaiveSgmSettings& settings) {
  const cv::Mat1b repeated = looks_repeated(cost);
  cv::Mat1b result(right.rows, right.cols);
  for (int y = 0; y < right.rows; ++y) {
    for (int x = 0; x < right.cols; ++x) {
      const bool ambiguous = is_ambiguous(repeated, x, y, settings.repetition_px);
      const bool textured = texture(right, x, y) >= settings.texture_min;
      result(y, x) = !ambiguous && textured ? 1 : 0;
    }
  }
  return result;
}

/// Copy in which pixels that are 0 in `confident` have no disparity.
inline cv::Mat1s only_confident(const cv::Mat1s& image_64, const cv::Mat1b& confident) {
  cv::Mat1s result = image_64.clone();
  for (int y = 0; y < image_64.rows; ++y) {
    for (int x = 0; x < image_64.cols; ++x) {
      if (confident(y, x) == 0) {
        result(y, x) = kNoDisparity64;
      }
    }
  }
  return result;
}

/// Disparity of one right pixel in 1/64 px from the aggregated costs, or kNoDisparity64 where the
/// match is outside the left image, not unique or not confirmed from the left (Hirschmueller
/// 2008, disparity computation).
inline int winner_64(const Volume& sums, int x, int y, const NaiveSgmSettings& settings) {
  const int best = best_disparity(sums, x, y);
  if (x + best >= sums.width_px) {
    return kNoDisparity64;
  }
  if (!is_unique(sums, x, y, best, settings.uniqueness_percent)) {
    return kNoDisparity64;
  }
  const int disparity_64 = refined_64(sums, x, y, best);
  const int from_left_64 = 64 * best_left_disparity(sums, x + best, y);
  if (std::abs(from_left_64 - disparity_64) > settings.left_right_64) {
    return kNoDisparity64;
  }
  return disparity_64;
}

/// Disparity image in 1/64 px from the aggregated costs S, the matching cost C and the raw right
/// image: kNoDisparity64 where winner_64 finds none and where the pixel is not confident.
inline cv::Mat1s winner(const Volume& sums,
                        const Volume& cost,
                        const cv::Mat1b& right,
                        const NaiveSgmSettings& settings) {
  cv::Mat1s result(right.rows, right.cols);
  for (int y = 0; y < right.rows; ++y) {
    for (int x = 0; x < right.cols; ++x) {
      result(y, x) = static_cast<std::int16_t>(winner_64(sums, x, y, settings));
    }
  }
  return only_confident(result, confident(cost, right, settings));
}

/// Whether (x, y) is inside the image and has a disparity.
inline bool has_disparity(const cv::Mat1s& image_64, int x, int y) {
  const bool inside = x >= 0 && x < image_64.cols && y >= 0 && y < image_64.rows;
  return inside && image_64(y, x) != kNoDisparity64;
}

/// Value above all disparities of 1/64 px; only inside the median.
inline constexpr std::int16_t kAboveAll64 = std::numeric_limits<std::int16_t>::max();

/// Value that the median takes for (x, y), which may be outside the image: the disparity if there
/// is one, else a value below all others where x + y is even and above all others where it is odd.
inline std::int16_t stand_in(const cv::Mat1s& image_64, int x, int y) {
  if (has_disparity(image_64, x, y)) {
    return image_64(y, x);
  }
  return (x + y) % 2 == 0 ? kNoDisparity64 : kAboveAll64;
}

/// Third smallest of five values.
inline std::int16_t median_of_five(std::array<std::int16_t, 5> values) {
  std::sort(values.begin(), values.end());
  return values[2];
}

/// Median of the stand-ins at (x - 2, y) to (x + 2, y); (x, y) may be outside the image.
inline std::int16_t row_median(const cv::Mat1s& image_64, int x, int y) {
  return median_of_five({stand_in(image_64, x - 2, y),
                         stand_in(image_64, x - 1, y),
                         stand_in(image_64, x, y),
                         stand_in(image_64, x + 1, y),
                         stand_in(image_64, x + 2, y)});
}

/// Separable 5x5 median: the median of the row medians at (x, y - 2) to (x, y + 2).
inline std::int16_t separable_median(const cv::Mat1s& image_64, int x, int y) {
  return median_of_five({row_median(image_64, x, y - 2),
                         row_median(image_64, x, y - 1),
                         row_median(image_64, x, y),
                         row_median(image_64, x, y + 1),
                         row_median(image_64, x, y + 2)});
}

/// Number of pixels in the 5x5 window that are inside the image and have a disparity.
inline int valid_count(const cv::Mat1s& image_64, int x, int y) {
  int count = 0;
  for (int v = y - 2; v <= y + 2; ++v) {
    for (int u = x - 2; u <= x + 2; ++u) {
      if (has_disparity(image_64, u, v)) {
        ++count;
      }
    }
  }
  return count;
}

/// Result of the median at (x, y): kNoDisparity64 where the median is a stand-in for a missing
/// disparity, and for an invalid pixel with fewer than fill_min valid ones in its window.
inline std::int16_t filled_median(const cv::Mat1s& image_64, int x, int y, int fill_min) {
  if (!has_disparity(image_64, x, y) && valid_count(image_64, x, y) < fill_min) {
    return kNoDisparity64;
  }
  const std::int16_t median = separable_median(image_64, x, y);
  return median == kAboveAll64 ? kNoDisparity64 : median;
}

/// One pass of the separable 5x5 median that also fills small gaps; every pixel from the given
/// image.
inline cv::Mat1s median_filled(const cv::Mat1s& image_64, const NaiveSgmSettings& settings) {
  cv::Mat1s result(image_64.rows, image_64.cols);
  for (int y = 0; y < image_64.rows; ++y) {
    for (int x = 0; x < image_64.cols; ++x) {
      result(y, x) = filled_median(image_64, x, y, settings.fill_min);
    }
  }
  return result;
}

/// The four neighbours of a pixel; some may be outside the image.
inline std::array<Pixel, 4> four_neighbours(Pixel pixel) {
  return {{{pixel.x - 1, pixel.y},
           {pixel.x + 1, pixel.y},
           {pixel.x, pixel.y - 1},
           {pixel.x, pixel.y + 1}}};
}

/// The 4-connected component of valid pixels around `start` in which neighbours differ by at most
/// step_64 (Hirschmueller 2008, removal of peaks). Marks its pixels with 1 in `visited`.
inline std::vector<Pixel> component(const cv::Mat1s& image_64,
                                    cv::Mat1b& visited,
                                    Pixel start,
                                    int step_64) {
  std::vector<Pixel> pixels{start};
  visited(start.y, start.x) = 1;
  for (std::size_t next = 0; next < pixels.size(); ++next) {
    const Pixel pixel = pixels[next];
    for (const Pixel& neighbour : four_neighbours(pixel)) {
      if (!has_disparity(image_64, neighbour.x, neighbour.y) ||
          visited(neighbour.y, neighbour.x) == 1) {
        continue;
      }
      if (std::abs(image_64(pixel.y, pixel.x) - image_64(neighbour.y, neighbour.x)) <= step_64) {
        visited(neighbour.y, neighbour.x) = 1;
        pixels.push_back(neighbour);
      }
    }
  }
  return pixels;
}

/// Copy in which components of fewer than speckle_size_px pixels have no disparity (Hirschmueller
/// 2008, removal of peaks).
inline cv::Mat1s without_speckles(const cv::Mat1s& image_64, const NaiveSgmSettings& settings) {
  cv::Mat1s result = image_64.clone();
  cv::Mat1b visited(image_64.rows, image_64.cols, std::uint8_t{0});
  for (int y = 0; y < image_64.rows; ++y) {
    for (int x = 0; x < image_64.cols; ++x) {
      if (!has_disparity(image_64, x, y) || visited(y, x) == 1) {
        continue;
      }
      const std::vector<Pixel> pixels =
          component(image_64, visited, Pixel{x, y}, settings.speckle_step_64);
      if (static_cast<int>(pixels.size()) >= settings.speckle_size_px) {
        continue;
      }
      for (const Pixel& pixel : pixels) {
        result(pixel.y, pixel.x) = kNoDisparity64;
      }
    }
  }
  return result;
}

/// Whether a valid neighbour of the valid pixel (x, y) differs from it by more than edge_step_64.
inline bool is_depth_edge(const cv::Mat1s& image_64, int x, int y, int edge_step_64) {
  for (const Pixel& neighbour : four_neighbours(Pixel{x, y})) {
    if (has_disparity(image_64, neighbour.x, neighbour.y) &&
        std::abs(image_64(y, x) - image_64(neighbour.y, neighbour.x)) > edge_step_64) {
      return true;
    }
  }
  return false;
}

/// Copy in which the pixels on both sides of a depth edge have no disparity, all judged on the
/// given image; edge_step_64 = 0 drops none.
inline cv::Mat1s without_edges(const cv::Mat1s& image_64, const NaiveSgmSettings& settings) {
  cv::Mat1s result = image_64.clone();
  if (settings.edge_step_64 == 0) {
    return result;
  }
  for (int y = 0; y < image_64.rows; ++y) {
    for (int x = 0; x < image_64.cols; ++x) {
      if (has_disparity(image_64, x, y) && is_depth_edge(image_64, x, y, settings.edge_step_64)) {
        result(y, x) = kNoDisparity64;
      }
    }
  }
  return result;
}

/// Copy in which a pixel whose match is right of the last column of the other image, of the same
/// size, has no disparity. For the image aligned with the right one: the match is at x + d.
inline cv::Mat1s within_other_image(const cv::Mat1s& image_64) {
  cv::Mat1s result = image_64.clone();
  for (int y = 0; y < image_64.rows; ++y) {
    for (int x = 0; x < image_64.cols; ++x) {
      if (has_disparity(image_64, x, y) && 64 * x + image_64(y, x) > 64 * (image_64.cols - 1)) {
        result(y, x) = kNoDisparity64;
      }
    }
  }
  return result;
}

/// The image with left and right exchanged.
template <class Value>
cv::Mat_<Value> mirrored(const cv::Mat_<Value>& image) {
  cv::Mat_<Value> result(image.rows, image.cols);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      result(y, x) = image(y, image.cols - 1 - x);
    }
  }
  return result;
}

/// Disparity in px from 1/64 px; NaN where there is none.
inline cv::Mat1f in_pixels(const cv::Mat1s& image_64) {
  cv::Mat1f result(image_64.rows, image_64.cols);
  for (int y = 0; y < image_64.rows; ++y) {
    for (int x = 0; x < image_64.cols; ++x) {
      result(y, x) = std::numeric_limits<float>::quiet_NaN();
      if (has_disparity(image_64, x, y)) {
        result(y, x) = static_cast<float>(image_64(y, x)) / 64.0F;
      }
    }
  }
  return result;
}

/// Disparity in px aligned with the right image: right pixel (x, y) shows what left pixel
/// (x + d, y) shows. NaN where there is none.
inline cv::Mat1f right_aligned(const cv::Mat1b& left,
                               const cv::Mat1b& right,
                               const NaiveSgmSettings& settings) {
  const Volume cost = matching_cost(left, right, settings.max_disparity_px);
  cv::Mat1s image_64 = winner(aggregate(cost, right, settings), cost, right, settings);
  for (int pass = 0; pass < settings.median_passes; ++pass) {
    image_64 = median_filled(image_64, settings);
  }
  image_64 = only_confident(image_64, confident(cost, right, settings));
  image_64 = without_speckles(image_64, settings);
  image_64 = without_edges(image_64, settings);
  return in_pixels(within_other_image(image_64));
}

/// Semi-global matching (Hirschmueller 2008) of a rectified pair of one size: disparity in px
/// along the row, NaN where there is none. Aligned with the right image, or with the left one if
/// align_left, which is the same on the mirrored pair with the images exchanged.
inline cv::Mat1f naive_sgm(const cv::Mat1b& left,
                           const cv::Mat1b& right,
                           const NaiveSgmSettings& settings) {
  if (settings.align_left) {
    return mirrored<float>(
        right_aligned(mirrored<std::uint8_t>(right), mirrored<std::uint8_t>(left), settings));
  }
  return right_aligned(left, right, settings);
}

}  // namespace skyhalo::reference
