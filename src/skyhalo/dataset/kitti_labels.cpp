#include "skyhalo/dataset/kitti_labels.hpp"

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

constexpr std::size_t kColumns = 17;
constexpr std::size_t kColumnsWithScore = 18;
constexpr std::size_t kTypeColumn = 2;
constexpr std::size_t kFirstBoxColumn = 10;
constexpr int kMaxFrame = 1'000'000;

/// One line of a label file with the place it came from.
struct LabelLine {
  const std::filesystem::path& file;
  int number;
  std::vector<std::string_view> words;

  [[nodiscard]] Error error(const std::string& message) const {
    return input_error(file, number, message);
  }

  [[nodiscard]] int whole_number(std::size_t column) const {
    const std::optional<int> value = parse_whole_number(words[column]);
    if (!value) {
      throw error("column " + std::to_string(column + 1) + ": expected a whole number, found '" +
                  std::string(words[column]) + "'");
    }
    return *value;
  }

  [[nodiscard]] double real_number(std::size_t column) const {
    const std::optional<double> value = parse_number(words[column]);
    if (!value) {
      throw error("column " + std::to_string(column + 1) + ": expected a finite number, found '" +
                  std::string(words[column]) + "'");
    }
    return *value;
  }
};

OrientedBox read_box(const LabelLine& line) {
  std::array<double, kColumns - kFirstBoxColumn> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    v.at(i) = line.real_number(kFirstBoxColumn + i);
  }
  if (!(v[0] > 0.0 && v[1] > 0.0 && v[2] > 0.0)) {
    throw line.error("columns 11 to 13: expected a height, width and length above 0 m");
  }
  return to_oriented_box({v[0], v[1], v[2], {v[3], v[4], v[5]}, v[6]});
}

}  // namespace

OrientedBox to_oriented_box(const LabelBox& label) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(label.rotation_y_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Vector3d corner(-label.length_m / 2.0, 0.0, -label.width_m / 2.0);
  const Eigen::Vector3d extent(label.length_m, -label.height_m, label.width_m);
  return {label.bottom_center_m + R * corner, R * extent.asDiagonal()};
}

TrackLabels::TrackLabels(const std::filesystem::path& file) {
  int number = 0;
  for (const std::string& text : read_lines(file)) {
    const LabelLine line{file, ++number, split_words(text)};
    if (line.words.empty()) {
      continue;
    }
    if (line.words.size() != kColumns && line.words.size() != kColumnsWithScore) {
      throw line.error("expected 17 columns, found " + std::to_string(line.words.size()));
    }
    for (std::size_t column = kTypeColumn + 1; column < line.words.size(); ++column) {
      (void)line.real_number(column);
    }
    const int frame = line.whole_number(0);
    const int track = line.whole_number(1);
    if (frame < 0 || frame > kMaxFrame) {
      throw line.error("column 1: expected a frame number >= 0");
    }
    if (frame > last_frame_) {
      last_frame_ = frame;
      last_frame_line_ = number;
      frames_.resize(static_cast<std::size_t>(frame) + 1);
    }
    if (line.words[kTypeColumn] != "DontCare") {
      frames_[static_cast<std::size_t>(frame)].push_back(
          {frame, track, std::string(line.words[kTypeColumn]), read_box(line)});
    }
  }
}

std::span<const TrackedObject> TrackLabels::objects(int frame) const noexcept {
  if (frame < 0 || frame > last_frame_) {
    return {};
  }
  return frames_[static_cast<std::size_t>(frame)];
}

}  // namespace skyhalo
