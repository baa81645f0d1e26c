#include "skyhalo/io/pcd.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <string>

#include "skyhalo/io/output_folder.hpp"

namespace skyhalo {

void write_pcd(const std::filesystem::path& file, const std::vector<OccupiedPoint>& points) {
  static_assert(std::endian::native == std::endian::little,
                "floats are copied as they lie in memory");
  const std::string count = std::to_string(points.size());
  std::string bytes =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity\n"
      "SIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH " +
      count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
  bytes.reserve(bytes.size() + points.size() * 4 * sizeof(float));
  for (const OccupiedPoint& point : points) {
    const std::array<float, 4> values{
        point.center_m.x(), point.center_m.y(), point.center_m.z(), point.probability};
    std::array<char, sizeof(values)> raw{};
    std::memcpy(raw.data(), values.data(), raw.size());
    bytes.append(raw.data(), raw.size());
  }
  write_bytes(file, bytes);
}

}  // namespace skyhalo
