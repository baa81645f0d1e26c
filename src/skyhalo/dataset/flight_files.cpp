#include "skyhalo/dataset/flight_files.hpp"

#include <array>
#include <cmath>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/dataset/csv_table.hpp"
#include "skyhalo/dataset/frame_checks.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;

Error wrong_count(const fs::path& file, std::size_t found, int frames) {
  return input_error(file,
                     "has " + std::to_string(found) + " lines of data, expected one for each of " +
                         std::to_string(frames) + " frames");
}

/// The rows of a table with a line per frame, in order.
std::vector<CsvRow> rows_of_frames(const fs::path& file, std::string_view header, int frames) {
  std::vector<CsvRow> rows = read_csv(file, header);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].whole_number(0) != static_cast<int>(i)) {
      throw rows[i].error("column 1: expected frame " + std::to_string(i) + ", found '" +
                          rows[i].text(0) + "'");
    }
  }
  if (rows.size() != static_cast<std::size_t>(frames)) {
    throw wrong_count(file, rows.size(), frames);
  }
  return rows;
}

Pose parse_pose(const fs::path& file, int number, const std::string& line) {
  const std::vector<std::string_view> words = split_words(line);
  constexpr std::size_t kNumbers = 12;
  if (words.size() != kNumbers) {
    throw input_error(file, number, "expected 12 numbers, found " + std::to_string(words.size()));
  }
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> T;
  for (std::size_t i = 0; i < kNumbers; ++i) {
    const std::optional<double> value = parse_number(words[i]);
    if (!value) {
      throw input_error(file,
                        number,
                        "value " + std::to_string(i + 1) + ": expected a finite number, found '" +
                            std::string(words[i]) + "'");
    }
    T.data()[i] = *value;
  }
  Pose pose = make_pose(T.leftCols<3>(), T.col(3));
  if (!is_rigid(pose)) {
    throw input_error(file, number, "its first three columns are not a rotation matrix");
  }
  return pose;
}

SceneObject parse_object(const CsvRow& row) {
  SceneObject object{
      .track = row.whole_number(1), .type = row.text(2), .occluded = row.whole_number(10)};
  object.size_m = {row.number(7), row.number(8), row.number(9)};
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(row.number(6), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  object.T_map_object = make_pose(R, {row.number(3), row.number(4), row.number(5)});
  try {
    check(object, row.whole_number(0));
  } catch (const Error& error) {
    throw row.error(error.what());
  }
  return object;
}

}  // namespace

std::vector<Timestamp> read_flight_stamps(const fs::path& file, int frames) {
  std::vector<Timestamp> stamps;
  for (const CsvRow& row : rows_of_frames(file, kFramesHeader, frames)) {
    const Timestamp stamp = row.stamp(1);
    if (!stamps.empty() && stamp <= stamps.back()) {
      throw row.error("the time stamp is not after the one of the frame before; they must grow");
    }
    stamps.push_back(stamp);
  }
  return stamps;
}

std::vector<Pose> read_flight_poses(const fs::path& file, int frames) {
  std::vector<Pose> poses;
  int number = 0;
  for (const std::string& line : read_lines(file)) {
    poses.push_back(parse_pose(file, ++number, line));
  }
  if (poses.size() != static_cast<std::size_t>(frames)) {
    throw wrong_count(file, poses.size(), frames);
  }
  return poses;
}

std::string pose_line(const Pose& pose) {
  std::string line;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      line += (line.empty() ? "" : " ") + exact_number_text(pose.matrix()(row, column));
    }
  }
  return line + "\n";
}

std::vector<std::optional<double>> read_flight_sonar(const fs::path& file,
                                                     std::span<const Timestamp> stamps) {
  std::vector<std::optional<double>> ranges_m;
  for (const CsvRow& row : rows_of_frames(file, kSonarHeader, static_cast<int>(stamps.size()))) {
    if (row.stamp(1) != stamps[ranges_m.size()]) {
      throw row.error("column 2: expected the frame's time stamp, as in frames.csv");
    }
    ranges_m.push_back(row.text(2).empty() ? std::nullopt : std::optional(row.number(2)));
    if (ranges_m.back().value_or(0.0) < 0.0) {
      throw row.error("column 3: expected a range >= 0 m, or nothing");
    }
  }
  return ranges_m;
}

std::vector<std::vector<SceneObject>> read_flight_objects(const fs::path& file, int frames) {
  std::vector<std::vector<SceneObject>> objects(static_cast<std::size_t>(frames));
  for (const CsvRow& row : read_csv(file, kObjectsHeader)) {
    const int frame = row.whole_number(0);
    if (frame < 0 || frame >= frames) {
      throw row.error("column 1: expected a frame in 0..." + std::to_string(frames - 1));
    }
    objects[static_cast<std::size_t>(frame)].push_back(parse_object(row));
  }
  return objects;
}

std::string object_line(const SceneObject& object, int frame) {
  const Eigen::Vector3d p_m = object.T_map_object.translation();
  const Eigen::Vector3d ahead = object.T_map_object.linear().col(0);
  std::string line = std::to_string(frame) + "," + std::to_string(object.track) + "," + object.type;
  for (const double value : {p_m.x(),
                             p_m.y(),
                             p_m.z(),
                             std::atan2(ahead.y(), ahead.x()),
                             object.size_m.x(),
                             object.size_m.y(),
                             object.size_m.z()}) {
    line += "," + exact_number_text(value);
  }
  return line + "," + std::to_string(object.occluded) + "\n";
}

}  // namespace skyhalo
