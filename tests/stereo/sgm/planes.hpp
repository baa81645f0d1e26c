#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <opencv2/core.hpp>
#include <random>
#include <string>

#include "skyhalo/stereo/sgm/plane.hpp"
#include "support/instruction_set.hpp"

namespace skyhalo::testing {

template <class T>
sgm::Plane<T> plane_of(const cv::Mat_<T>& image) {
  sgm::Plane<T> plane(image.cols, image.rows);
  for (int v = 0; v < image.rows; ++v) {
    std::copy_n(image[v], image.cols, plane.row(v));
  }
  return plane;
}

/// With the outermost pixels in its margins, as grey images have it.
inline sgm::Plane<std::uint8_t> grey_plane(const cv::Mat1b& image) {
  sgm::Plane<std::uint8_t> plane = plane_of(image);
  for (int v = 0; v < image.rows; ++v) {
    plane.replicate_sides(v);
  }
  return plane;
}

/// With nothing in its margins, as images of disparity have it.
inline sgm::Plane<std::int16_t> disparity_plane(const cv::Mat1s& image_64) {
  sgm::Plane<std::int16_t> plane = plane_of(image_64);
  plane.fill_margin(-1);
  return plane;
}

template <class T>
cv::Mat_<T> image_of(const sgm::Plane<T>& plane) {
  cv::Mat_<T> image(plane.height(), plane.width());
  for (int v = 0; v < image.rows; ++v) {
    std::copy_n(plane.row(v), image.cols, image[v]);
  }
  return image;
}

template <class T>
T bits_of(T value) {
  return value;
}

inline std::uint32_t bits_of(float value) {
  return std::bit_cast<std::uint32_t>(value);
}

/// Where two images first differ in their bits, with their values; empty if they do not.
template <class T>
std::string first_difference(const cv::Mat_<T>& found, const cv::Mat_<T>& expected) {
  if (found.size() != expected.size()) {
    return "the sizes";
  }
  for (int v = 0; v < found.rows; ++v) {
    for (int u = 0; u < found.cols; ++u) {
      if (bits_of(found(v, u)) != bits_of(expected(v, u))) {
        return "(" + std::to_string(u) + ", " + std::to_string(v) +
               "): " + std::to_string(found(v, u)) + " instead of " +
               std::to_string(expected(v, u));
      }
    }
  }
  return "";
}

/// Does the work with each of this processor's instruction sets.
template <class Work>
void for_each_instruction_set(const Work& work) {
  for (const std::int64_t target : InstructionSet::all()) {
    SCOPED_TRACE(InstructionSet::name(target));
    const InstructionSet in_use(target);
    work();
  }
}

/// Random grey of the given range, the same for the same state of `random`.
inline cv::Mat1b random_grey(const cv::Size& size,
                             int darkest,
                             int brightest,
                             std::mt19937& random) {
  std::uniform_int_distribution<int> level(darkest, brightest);
  cv::Mat1b image(size);
  for (std::uint8_t& pixel : image) {
    pixel = static_cast<std::uint8_t>(level(random));
  }
  return image;
}

/// Patches of slowly changing disparity (1/64 px) with noise, steps between them and holes.
inline cv::Mat1s random_disparity_64(const cv::Size& size, std::mt19937& random) {
  const auto draw = [&random](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  cv::Mat1s image(size, static_cast<std::int16_t>(draw(0, 255) * 64));
  for (int patch = draw(0, 12); patch > 0; --patch) {
    const cv::Point corner(draw(0, size.width - 1), draw(0, size.height - 1));
    const cv::Point end(draw(corner.x, size.width), draw(corner.y, size.height));
    const int level = draw(0, 2) == 0 ? -1 : draw(0, 255 * 64);
    image(cv::Rect(corner, end)) = static_cast<std::int16_t>(level);
  }
  const int noise = draw(0, 1) * draw(0, 80);
  const int holes_percent = draw(0, 60);
  for (std::int16_t& pixel : image) {
    const int noisy = std::clamp(pixel + draw(-noise, noise), 0, 255 * 64 + 32);
    const bool hole = pixel < 0 || draw(0, 99) < holes_percent;
    pixel = static_cast<std::int16_t>(hole ? -1 : noisy);
  }
  return image;
}

/// Sizes around those of the vectors, and any others.
inline cv::Size random_size(int most_rows, std::mt19937& random) {
  const auto draw = [&random](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  const int width = draw(0, 2) == 0 ? std::max(1, 16 * draw(0, 9) + draw(-2, 2)) : draw(1, 150);
  return {width, draw(1, most_rows)};
}

}  // namespace skyhalo::testing
