#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace skyhalo {

/// A picture and its title.
struct TitledPicture {
  std::string title;
  cv::Mat3b picture;
};

/// Pictures under their titles, `columns` in a row, each scaled to `width_px`.
[[nodiscard]] cv::Mat3b contact_sheet(const std::vector<TitledPicture>& pictures,
                                      int columns,
                                      int width_px);

}  // namespace skyhalo
