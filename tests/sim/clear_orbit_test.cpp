#include "skyhalo/sim/clear_orbit.hpp"

#include <gtest/gtest.h>

#include <string>

#include "skyhalo/sim/make_scene.hpp"
#include "skyhalo/sim/path_check.hpp"
#include "skyhalo/sim/shapes.hpp"
#include "support/sanitised.hpp"

namespace skyhalo {
namespace {

/// Two walls along x, `gap_m` apart, and a route of 20 m between them.
Scene lane(float gap_m) {
  Scene scene;
  scene.name = "lane";
  scene.materials.resize(1);
  for (const float y_m : {-0.5F * gap_m, 0.5F * gap_m}) {
    add_quad(scene.fixed,
             {Eigen::Vector3f(-40.0F, y_m, 0.0F),
              Eigen::Vector3f(40.0F, y_m, 0.0F),
              Eigen::Vector3f(40.0F, y_m, 4.0F),
              Eigen::Vector3f(-40.0F, y_m, 4.0F)},
             {});
  }
  scene.route_m = {{-10.0, 0.0, 2.0}, {10.0, 0.0, 2.0}};
  return scene;
}

TEST(ClearOrbitTest, IsAsWideAsTheLaneLets) {
  const auto orbit = clear_orbit(lane(6.0F), 4.0, 0.4);
  ASSERT_TRUE(orbit);
  // At most 2.6 m; the next wider one that is tried would touch.
  EXPECT_LE(orbit->radius_m, 2.6);
  EXPECT_GE(orbit->radius_m, 0.8 * 2.6);
  EXPECT_EQ(orbit->centre_m, Eigen::Vector3d(0.0, 0.0, 2.0));
  EXPECT_LE(orbit->speed_mps * orbit->speed_mps / orbit->radius_m, 3.0 + 1e-9);
}

TEST(ClearOrbitTest, WithoutRoomOrRouteThereIsNone) {
  EXPECT_FALSE(clear_orbit(lane(1.0F), 4.0, 0.4));
  Scene scene = lane(6.0F);
  scene.route_m.clear();
  EXPECT_FALSE(clear_orbit(scene, 4.0, 0.4));
}

TEST(ClearOrbitProperty, EverySceneHasOne) {
  for (const SceneKind& kind : scene_kinds()) {
    if (testing::kSanitised && kind.name != "tunnel") {
      continue;
    }
    const Scene scene = make_scene({.name = std::string(kind.name), .difficulty = 0.5, .seed = 1});
    const auto orbit = clear_orbit(scene, 4.0, 0.4);
    ASSERT_TRUE(orbit) << kind.name;
    const Trajectory flight = fly_orbit(*orbit);
    const SceneTracer tracer(scene);
    EXPECT_FALSE(first_collision(tracer, flight, flight.duration_s(), 0.4)) << kind.name;
    RecordProperty(std::string(kind.name), std::to_string(orbit->radius_m));
  }
}

}  // namespace
}  // namespace skyhalo
