#include "skyhalo/io/trajectory_file.hpp"

#include <array>
#include <cstdio>
#include <string>

#include "skyhalo/io/output_folder.hpp"

namespace skyhalo {

void write_tum(const std::filesystem::path& file, const std::vector<StampedPose>& trajectory) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d t_m = pose.T_map_body.translation();
    const Eigen::Quaterniond q(pose.T_map_body.linear());
    const auto ns = pose.stamp.time_since_epoch().count();
    std::array<char, 256> line{};
    const int length = std::snprintf(line.data(),
                                     line.size(),
                                     "%lld.%09lld %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n",
                                     static_cast<long long>(ns / 1'000'000'000),
                                     static_cast<long long>(ns % 1'000'000'000),
                                     t_m.x(),
                                     t_m.y(),
                                     t_m.z(),
                                     q.x(),
                                     q.y(),
                                     q.z(),
                                     q.w());
    text.append(line.data(), static_cast<std::size_t>(length));
  }
  write_bytes(file, text);
}

}  // namespace skyhalo
