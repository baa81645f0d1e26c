#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skyhalo/base/timestamp.hpp"
#include "skyhalo/dataset/scene_object.hpp"

namespace skyhalo {

// The single files of skyhalo's own recordings; docs/recordings.md describes them. All reading
// throws `Error` (input) naming the file and the line or key. Internal to this layer.

inline constexpr const char* kFlightFile = "flight.json";
inline constexpr const char* kFlightFormat = "skyhalo-flight";
inline constexpr int kFlightVersion = 1;

inline constexpr const char* kFramesHeader = "frame,stamp_ns";
inline constexpr const char* kSonarHeader = "frame,stamp_ns,range_m";
inline constexpr const char* kObjectsHeader =
    "frame,track,type,x_m,y_m,z_m,yaw_rad,length_m,width_m,height_m,occluded";

/// `flight.json`: what there is.
struct FlightHead {
  std::string name;
  std::map<std::string, std::string> source;  ///< free words
  int frames = 0;                             ///< > 0
  std::optional<Pose> T_body_laser;           ///< set when there is a laser scanner
  bool has_sonar = false;
  bool has_objects = false;
  bool has_true_poses = false;
};

[[nodiscard]] FlightHead read_flight_head(const std::filesystem::path& file);
[[nodiscard]] std::string to_json_text(const FlightHead& head);

/// `frames.csv`: a stamp for each of so many frames, growing.
[[nodiscard]] std::vector<Timestamp> read_flight_stamps(const std::filesystem::path& file,
                                                        int frames);

/// `poses.txt`: a line per frame with the upper 3 rows of a pose's matrix.
[[nodiscard]] std::vector<Pose> read_flight_poses(const std::filesystem::path& file, int frames);
[[nodiscard]] std::string pose_line(const Pose& pose);

/// `sonar.csv`: a range (m) per frame, at the frame's stamp; none: no echo.
[[nodiscard]] std::vector<std::optional<double>> read_flight_sonar(
    const std::filesystem::path& file, std::span<const Timestamp> stamps);

/// `objects.csv`: the objects of each frame.
[[nodiscard]] std::vector<std::vector<SceneObject>> read_flight_objects(
    const std::filesystem::path& file, int frames);
[[nodiscard]] std::string object_line(const SceneObject& object, int frame);

}  // namespace skyhalo
