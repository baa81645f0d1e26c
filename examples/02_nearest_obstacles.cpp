// How far is the nearest thing in each direction? A disparity image becomes a spherical grid round
// the body.

#include <cstdio>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/sphere/accumulate.hpp"

int main() {
  using skyhalo::rad_from_deg;

  // A pair that looks forward: cam x right is body -y, cam y down is body -z, cam z forward is body
  // x.
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const skyhalo::PairGeometry pair{
      .model =
          skyhalo::PinholePair{
              .focal_px = 300, .principal_u_px = 160, .principal_v_px = 60, .baseline_m = 0.2},
      .T_body_camera = skyhalo::make_pose(R_body_camera, Eigen::Vector3d::Zero()),
      .max_range_m = 30};

  // 15 px everywhere is a wall 300 * 0.2 / 15 = 4 m ahead.
  const cv::Mat1f disparity(120, 320, 15.0F);

  skyhalo::SphericalGrid grid(skyhalo::make_grid_geometry({.theta_min_rad = rad_from_deg(60),
                                                           .theta_max_rad = rad_from_deg(120),
                                                           .phi_min_rad = rad_from_deg(-50),
                                                           .phi_max_rad = rad_from_deg(50),
                                                           .step_rad = rad_from_deg(2)}));
  skyhalo::accumulate(disparity, pair, grid);

  const auto ahead = grid.geometry().cell_of(rad_from_deg(90), rad_from_deg(0));
  const auto depth_m = ahead ? grid.depth_m(*ahead) : std::nullopt;
  if (!depth_m) {
    return 1;
  }
  std::printf("straight ahead: %.2f m; %d of %d cells see something\n",
              *depth_m,
              grid.occupied_cell_count(),
              grid.geometry().cell_count());
  return 0;
}
