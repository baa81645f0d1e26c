#include "skyhalo/dataset/velodyne_file.hpp"

#include <array>
#include <cstring>
#include <string>

#include "skyhalo/base/error.hpp"
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

}  // namespace skyhalo
