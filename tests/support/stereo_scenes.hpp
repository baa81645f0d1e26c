#pragma once

#include <cmath>
#include <filesystem>
#include <limits>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "skyhalo/io/image_file.hpp"
#include "skyhalo/stereo/matcher_config.hpp"
#include "support/recorded_data.hpp"

namespace skyhalo::testing {

/// A recorded pair with its true disparities.
struct StereoScene {
  std::string name;
  cv::Mat left;
  cv::Mat right;
  cv::Mat1f truth_px;  ///< of the pixels that both cameras see; NaN elsewhere
  Alignment alignment = Alignment::kRight;
  int max_disparity_px = 64;
  double threshold_px = 1.0;  ///< a larger error is bad, by the custom of the data set
};

inline cv::Mat1f scaled_truth(const std::filesystem::path& file, double units_per_px) {
  cv::Mat1f truth;
  cv::Mat stored = read_image(file);
  cv::extractChannel(stored, stored, 0);  // some are grey, stored as colour
  stored.convertTo(truth, CV_32F, 1.0 / units_per_px);
  truth.setTo(std::numeric_limits<float>::quiet_NaN(), stored == 0);
  return truth;
}

/// Middlebury 2003 and 2001, right-aligned: pixels whose match says the same back are not occluded.
inline std::vector<StereoScene> middlebury_scenes() {
  std::vector<StereoScene> scenes;
  for (const auto& [name, scale] : {std::pair{"cones", 4.0}, {"teddy", 4.0}, {"venus", 8.0}}) {
    const std::filesystem::path folder = recorded_data() / "middlebury" / name;
    const cv::Mat1f left_truth = scaled_truth(folder / "disp2.png", scale);
    cv::Mat1f truth = scaled_truth(folder / "disp6.png", scale);
    for (int v = 0; v < truth.rows; ++v) {
      for (int u = 0; u < truth.cols; ++u) {
        const float d = truth(v, u);
        const int left_u =
            std::isnan(d) ? truth.cols : static_cast<int>(std::lround(static_cast<float>(u) + d));
        // Not so for NaN.
        const bool seen = left_u < truth.cols && std::abs(left_truth(v, left_u) - d) <= 1.0F;
        truth(v, u) = seen ? d : std::numeric_limits<float>::quiet_NaN();
      }
    }
    scenes.push_back({name, read_image(folder / "im2.png"), read_image(folder / "im6.png"), truth});
  }
  return scenes;
}

/// KITTI stereo 2012, left-aligned, of the pixels that are not occluded.
inline std::vector<StereoScene> kitti2012_scenes() {
  std::vector<StereoScene> scenes;
  for (const char* const name : {"000027", "000074", "000138"}) {
    const std::filesystem::path folder = recorded_data() / "kitti2012";
    const std::string file = std::string(name) + "_10.png";
    scenes.push_back({name,
                      read_image(folder / "image_0" / file),
                      read_image(folder / "image_1" / file),
                      scaled_truth(folder / "disp_noc" / file, 256.0),
                      Alignment::kLeft,
                      128,
                      3.0});
  }
  return scenes;
}

}  // namespace skyhalo::testing
