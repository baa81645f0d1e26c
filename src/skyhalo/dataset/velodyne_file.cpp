#include "skyhalo/dataset/velodyne_file.hpp"

#include <array>
#include <cstring>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {

LaserScan read_velodyne(const std::filesystem::path& file) {
  using Record = std::array<float, 4>;
  const std::string bytes = read_bytes(file);
  if (bytes.empty() || bytes.size() % sizeof(Record) != 0) {
    throw input_error(file,
                      "is cut off: " + std::to_string(bytes.size()) +
                          " bytes, expected a multiple of " + std::to_string(sizeof(Record)) +
                          " above 0");
  }
  LaserScan scan;
  scan.reserve(bytes.size() / sizeof(Record));
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(Record)) {
    Record record{};
    std::memcpy(record.data(), bytes.data() + at, sizeof(Record));
    const Eigen::Vector3f point_m(record[0], record[1], record[2]);
    if (point_m.allFinite()) {
      scan.push_back(point_m);
    }
  }
  return scan;
}

void write_velodyne(const std::filesystem::path& file, const LaserReturns& scan) {
  const std::size_t count = scan.points_m.size();
  if (!scan.reflectances.empty() && scan.reflectances.size() != count) {
    throw input_error(file,
                      "expected a reflectance for each of " + std::to_string(count) +
                          " points, found " + std::to_string(scan.reflectances.size()));
  }
  using Record = std::array<float, 4>;
  std::string bytes(count * sizeof(Record), '\0');
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f& p_m = scan.points_m[i];
    if (!p_m.allFinite()) {
      throw input_error(file, "point " + std::to_string(i) + " of the scan is not finite");
    }
    const float reflectance = scan.reflectances.empty() ? 0.0F : scan.reflectances[i];
    const Record record{p_m.x(), p_m.y(), p_m.z(), reflectance};
    std::memcpy(bytes.data() + i * sizeof(Record), record.data(), sizeof(Record));
  }
  write_bytes(file, bytes);
}

}  // namespace skyhalo
