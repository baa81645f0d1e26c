#include "skyhalo/sim/make_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "support/expect_error.hpp"
#include "support/sanitised.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3f;
using ::testing::HasSubstr;
using testing::message_of;

constexpr float kClearM = 1.2F;

/// The point of a triangle that is nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
Vector3f nearest_of_triangle(const Vector3f& p,
                             const Vector3f& a,
                             const Vector3f& b,
                             const Vector3f& c) {
  const auto on_segment = [&](const Vector3f& from, const Vector3f& to) -> Vector3f {
    const Vector3f way = to - from;
    const float square = std::max(way.squaredNorm(), 1e-12F);
    return from + std::clamp((p - from).dot(way) / square, 0.0F, 1.0F) * way;
  };
  const Vector3f normal = (b - a).cross(c - a);
  if (normal.squaredNorm() > 1e-14F) {
    Vector3f foot = p - (p - a).dot(normal) / normal.squaredNorm() * normal;
    if (normal.dot((b - a).cross(foot - a)) >= 0.0F &&
        normal.dot((c - b).cross(foot - b)) >= 0.0F &&
        normal.dot((a - c).cross(foot - c)) >= 0.0F) {
      return foot;
    }
  }
  Vector3f best = on_segment(a, b);
  for (const Vector3f& other : {on_segment(b, c), on_segment(c, a)}) {
    best = (other - p).squaredNorm() < (best - p).squaredNorm() ? other : best;
  }
  return best;
}

/// Points of the route about 0.25 m apart.
std::vector<Vector3f> samples(const Scene& scene) {
  std::vector<Vector3f> points;
  const std::size_t pieces = scene.route_m.size() - (scene.route_closed ? 0 : 1);
  for (std::size_t i = 0; i < pieces; ++i) {
    const Eigen::Vector3d from = scene.route_m[i];
    const Eigen::Vector3d way = scene.route_m[(i + 1) % scene.route_m.size()] - from;
    const int steps = std::max(1, static_cast<int>(way.norm() / 0.25));
    for (int k = 0; k < steps; ++k) {
      points.emplace_back((from + way * k / steps).cast<float>());
    }
  }
  return points;
}

/// How near any triangle comes to any of the points, down from 2 m.
float least_distance_m(const TriangleMesh& mesh, const std::vector<Vector3f>& points) {
  constexpr std::size_t kGroup = 12;
  std::vector<Eigen::AlignedBox3f> groups(points.size() / kGroup + 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    groups[i / kGroup].extend(points[i]);
  }
  float least = 2.0F;
  for (const auto& [ia, ib, ic] : mesh.triangles) {
    const Vector3f& a = mesh.vertices_m[ia];
    const Vector3f& b = mesh.vertices_m[ib];
    const Vector3f& c = mesh.vertices_m[ic];
    const Vector3f reach = Vector3f::Constant(least);
    const Eigen::AlignedBox3f box(a.cwiseMin(b).cwiseMin(c) - reach,
                                  a.cwiseMax(b).cwiseMax(c) + reach);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i % kGroup == 0 && !box.intersects(groups[i / kGroup])) {
        i += kGroup - 1;
      } else if (box.contains(points[i])) {
        least = std::min(least, (nearest_of_triangle(points[i], a, b, c) - points[i]).norm());
      }
    }
  }
  return least;
}

double route_length_m(const Scene& scene) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < scene.route_m.size(); ++i) {
    length_m += (scene.route_m[i] - scene.route_m[i - 1]).norm();
  }
  return length_m;
}

bool same(const Scene& a, const Scene& b) {
  return a.fixed.vertices_m == b.fixed.vertices_m && a.fixed.triangles == b.fixed.triangles &&
         a.fixed.uvs == b.fixed.uvs && a.fixed.materials == b.fixed.materials &&
         a.route_m == b.route_m && a.movers.size() == b.movers.size();
}

TEST(MakeSceneProperty, EverySceneIsSoundAndItsRouteLongLowAndClear) {
  for (const SceneKind& kind : scene_kinds()) {
    for (const auto& [difficulty, seed] :
         {std::pair{0.0, 1U}, std::pair{0.5, 2U}, std::pair{1.0, 5U}}) {
      if (testing::kSanitised && (difficulty != 0.0 || kind.name == "forest")) {
        continue;
      }
      SCOPED_TRACE(std::string(kind.name) + " at " + std::to_string(difficulty));
      const Scene scene = make_scene({std::string(kind.name), difficulty, seed});
      EXPECT_NO_THROW(check(scene));
      EXPECT_EQ(scene.name, kind.name);
      EXPECT_LT(scene.fixed.triangles.size(), kind.name == "forest" ? 1600000U : 150000U);
      EXPECT_GT(scene.fixed.triangles.size(), 1000U);
      EXPECT_GT(route_length_m(scene), 60.0);
      EXPECT_LT(route_length_m(scene), 140.0);
      for (const Eigen::Vector3d& point : scene.route_m) {
        EXPECT_LT(point.head<2>().cwiseAbs().maxCoeff(), 60.0);
        EXPECT_GT(point.z(), 0.0);
      }
      EXPECT_GE(least_distance_m(scene.fixed, samples(scene)), kClearM);
    }
  }
}

TEST(MakeSceneProperty, MoversKeepClearOfTheRoute) {
  for (const double difficulty : {0.5, 1.0}) {
    const Scene scene = make_scene({"yard", difficulty, 1});
    const std::vector<Vector3f> route = samples(scene);
    for (const MovingObject& mover : scene.movers) {
      for (int t_s = 0; t_s < testing::rounds(60); ++t_s) {
        TriangleMesh moved;
        append(moved, mover.mesh, T_scene_object(mover, t_s));
        EXPECT_GE(least_distance_m(moved, route), kClearM) << mover.track << " at " << t_s;
      }
    }
  }
}

TEST(MakeSceneTest, MoversAreBoxedAndNamedAsInKitti) {
  const Scene scene = make_scene({"yard", 0.5, 1});
  int cars = 0;
  int people = 0;
  for (const MovingObject& mover : scene.movers) {
    cars += mover.type == "Car" ? 1 : 0;
    people += mover.type == "Pedestrian" ? 1 : 0;
    const Eigen::AlignedBox3d box = bounds_of(mover.mesh);
    EXPECT_NEAR(box.min().z(), 0.0, 0.01);
    EXPECT_LE(box.max().z(), mover.size_m.z() + 0.02);
    EXPECT_LE(box.max().head<2>().cwiseAbs().cwiseMax(box.min().head<2>().cwiseAbs()).x(),
              0.5 * mover.size_m.x() + 0.03);
    EXPECT_LE(box.sizes().y(), mover.size_m.y() + 0.03);
  }
  EXPECT_GE(cars, 3);
  EXPECT_GE(people, 5);
}

TEST(MakeSceneProperty, TheSameWishGivesTheSameSceneAnotherOneNot) {
  if (testing::kSanitised) {
    GTEST_SKIP() << "takes minutes under a sanitiser, and others run the same code there";
  }
  for (const SceneKind& kind : scene_kinds()) {
    const std::string name(kind.name);
    const Scene scene = make_scene({name, 0.4, 9});
    EXPECT_TRUE(same(scene, make_scene({name, 0.4, 9}))) << name;
    const Scene harder = make_scene({name, 0.9, 9});
    const bool differs = !same(scene, harder);
    const Texture& first = scene.textures.front();
    const Texture& other = harder.textures.front();
    const bool fainter = first.at(0.1F, 0.3F, 0.0F) != other.at(0.1F, 0.3F, 0.0F);
    EXPECT_TRUE(differs || fainter) << name;
  }
}

TEST(MakeSceneTest, AHardTunnelIsPerfectlyUniform) {
  const auto wall = [](double difficulty, float u) {
    const Scene scene = make_scene({"tunnel", difficulty, 1});
    return scene.textures[static_cast<std::size_t>(scene.materials[0].texture)].at(u, 0.2F, 0.0F);
  };
  EXPECT_EQ(wall(1.0, 0.1F), wall(1.0, 0.73F));
  EXPECT_NE(wall(0.0, 0.1F), wall(0.0, 0.73F));
}

TEST(MakeSceneTest, WaterSendsNoLaserLightBack) {
  const Scene scene = make_scene({"water", 0.5, 1});
  const auto water = std::find_if(scene.materials.begin(),
                                  scene.materials.end(),
                                  [](const Material& each) { return each.name == "water"; });
  ASSERT_NE(water, scene.materials.end());
  EXPECT_EQ(water->laser_reflectivity, 0.0F);
  EXPECT_GT(water->mirror, 0.0F);
}

TEST(MakeSceneTest, AnUnknownSceneIsAnsweredWithTheKnownOnes) {
  EXPECT_EQ(message_of([] {
              (void)make_scene({"moon", 0.5, 1});
            }),
            "unknown scene \"moon\"; known: forest, street, warehouse, tunnel, fence, wires, "
            "water, yard");
}

TEST(MakeSceneTest, ADifficultyOutsideIsRefused) {
  for (const double wrong : {-0.01, 1.01, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(message_of([&] {
                  (void)make_scene({"tunnel", wrong, 1});
                }),
                HasSubstr("scene \"tunnel\": the difficulty must be in 0...1, got"));
  }
}

}  // namespace
}  // namespace skyhalo
