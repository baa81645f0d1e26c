#include "skyhalo/io/contact_sheet.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace skyhalo {
namespace {

constexpr int kGapPx = 12;
constexpr int kTitlePx = 28;

cv::Mat3b scaled_to_width(const cv::Mat3b& picture, int width_px) {
  const double scale = static_cast<double>(width_px) / picture.cols;
  cv::Mat3b tile;
  cv::resize(picture,
             tile,
             cv::Size(width_px, std::max(1, cvRound(picture.rows * scale))),
             0.0,
             0.0,
             scale < 1.0 ? cv::INTER_AREA : cv::INTER_NEAREST);
  return tile;
}

cv::Mat3b with_title(const TitledPicture& titled, int width_px) {
  const cv::Mat3b picture = scaled_to_width(titled.picture, width_px);
  cv::Mat3b tile(picture.rows + kTitlePx, width_px, cv::Vec3b(255, 255, 255));
  cv::putText(tile,
              titled.title,
              {0, 18},
              cv::FONT_HERSHEY_SIMPLEX,
              0.55,
              cv::Scalar(40, 40, 40),
              1,
              cv::LINE_AA);
  picture.copyTo(tile.rowRange(kTitlePx, tile.rows));
  return tile;
}

}  // namespace

cv::Mat3b contact_sheet(const std::vector<TitledPicture>& pictures, int columns, int width_px) {
  std::vector<cv::Mat3b> tiles;
  std::vector<cv::Point> places;
  int top_px = kGapPx;
  int row_height_px = 0;
  for (const TitledPicture& titled : pictures) {
    const int column = static_cast<int>(tiles.size()) % columns;
    if (column == 0 && !tiles.empty()) {
      top_px += row_height_px + kGapPx;
      row_height_px = 0;
    }
    tiles.push_back(with_title(titled, width_px));
    places.emplace_back(kGapPx + column * (width_px + kGapPx), top_px);
    row_height_px = std::max(row_height_px, tiles.back().rows);
  }
  cv::Mat3b sheet(top_px + row_height_px + kGapPx,
                  kGapPx + columns * (width_px + kGapPx),
                  cv::Vec3b(255, 255, 255));
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    tiles[i].copyTo(sheet(cv::Rect(places[i], tiles[i].size())));
  }
  return sheet;
}

}  // namespace skyhalo
