// Uses one piece of each kind of the installed library: a header with code, a compiled function,
// YAML, TBB and OctoMap behind it.

#include <cstdio>
#include <skyhalo/base/version.hpp>
#include <skyhalo/config/config.hpp>
#include <skyhalo/io/map_file.hpp>
#include <skyhalo/pipeline/obstacle_detector.hpp>

int main() {
  const skyhalo::Config config;
  const Eigen::AlignedBox3d bounds(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  skyhalo::DenseMap map(skyhalo::make_voxel_grid(bounds, 0.5));
  map.at(0) = 2000;
  skyhalo::write_octree("consumer.ot", map);
  const skyhalo::PinholePair model{30, 32, 16, 0.1};
  skyhalo::StereoRig rig;
  rig.pairs.push_back({.name = "front", .image_size_px = {64, 32}, .model = model});
  const skyhalo::ObstacleDetector detector(rig, config.detector, map.grid());
  std::printf("skyhalo %s: %zu occupied cell, %zu bytes of settings\n",
              skyhalo::kVersion,
              skyhalo::occupied_points(map, 0.7).size(),
              to_yaml(config).size());
  return detector.dense_map().cells().size() == map.cells().size() ? 0 : 1;
}
