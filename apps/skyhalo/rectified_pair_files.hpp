#pragma once

#include <opencv2/core/types.hpp>
#include <string>

#include "skyhalo/camera/stereo_rig.hpp"

namespace skyhalo::app {

/// Search ranges are multiples of this, in pixels of the matched images.
inline constexpr int kSearchStepPx = 16;

/// Both images as they are stored. Throws `Error` (input) naming the file when one cannot be read
/// or matched, or when they are not alike.
StereoImages read_rectified_pair(const std::string& left, const std::string& right);

/// How far disparities are searched for: by how much the images are shrunk, and the range in pixels
/// of the shrunk images.
struct SearchRange {
  int factor = 1;
  int range_px = 0;
};

/// Throws `Error` (input) naming the file when images of this size are too small for the search.
void check_room(const std::string& file, const cv::Size& size_px, const SearchRange& search);

/// What is matched: grey of 8 bits, shrunk by block means.
StereoImages shrunk_grey(const StereoImages& pair, int factor);

}  // namespace skyhalo::app
