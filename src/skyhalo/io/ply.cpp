#include "skyhalo/io/ply.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <string>

#include "skyhalo/io/output_folder.hpp"

namespace skyhalo {
namespace {

static_assert(std::endian::native == std::endian::little,
              "floats are copied as they lie in memory");

void append(std::string& bytes, float value) {
  std::array<char, sizeof(float)> raw{};
  std::memcpy(raw.data(), &value, raw.size());
  bytes.append(raw.data(), raw.size());
}

}  // namespace

void write_ply(const std::filesystem::path& file, const std::vector<ColouredPoint>& points) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment skyhalo, metres\nelement vertex " +
      std::to_string(points.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
      "property uchar green\nproperty uchar blue\nend_header\n";
  constexpr std::size_t kBytesPerPoint = 3 * sizeof(float) + 3;
  bytes.reserve(bytes.size() + points.size() * kBytesPerPoint);
  for (const ColouredPoint& point : points) {
    append(bytes, point.position_m.x());
    append(bytes, point.position_m.y());
    append(bytes, point.position_m.z());
    for (const int channel : {2, 1, 0}) {
      bytes.push_back(static_cast<char>(point.colour_bgr[channel]));
    }
  }
  write_bytes(file, bytes);
}

}  // namespace skyhalo
