#include "exact_map.hpp"

#include "skyhalo/sim/exact_occupancy.hpp"

namespace skyhalo::app {
namespace {

VoxelGrid grid_round(const SimulatedFlight& flight, double voxel_m) {
  Eigen::AlignedBox3d box;
  for (int frame = 0; frame < flight.frame_count(); ++frame) {
    box.extend(flight.T_scene_body(frame).translation());
  }
  box.min() -= Eigen::Vector3d(20.0, 20.0, 10.0);
  box.max() += Eigen::Vector3d(20.0, 20.0, 14.0);
  return make_voxel_grid(box, voxel_m);
}

}  // namespace

ExactMap::ExactMap(const SimulatedFlight& flight, double voxel_m)
    : flight_(flight),
      grid_(grid_round(flight, voxel_m)),
      occupied_(exact_occupancy(flight.scene().fixed, grid_)),
      seen_(grid_) {}

void ExactMap::look_from(int frame, int downscale) {
  const double t_s = flight_.time_s(frame);
  const SceneMoment moment(flight_.tracer(), {t_s, t_s});
  for (const StereoPair& pair : flight_.rig().pairs) {
    const int factor = pair.downscale.value_or(downscale);
    seen_.add(moment,
              skyhalo::downscaled(pair.model, factor),
              pair.image_size_px / factor,
              flight_.T_scene_body(frame) * pair.T_body_camera,
              {});
  }
}

}  // namespace skyhalo::app
