#include "skyhalo/sim/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kPi = std::numbers::pi_v<float>;

std::uint32_t add_vertex(TriangleMesh& mesh, const Vector3f& position_m, const Vector2f& uv) {
  mesh.vertices_m.push_back(position_m);
  mesh.uvs.push_back(uv);
  return static_cast<std::uint32_t>(mesh.vertices_m.size() - 1);
}

void add_triangle(TriangleMesh& mesh,
                  std::array<std::uint32_t, 3> corners,
                  std::uint16_t material) {
  mesh.triangles.push_back(corners);
  mesh.materials.push_back(material);
}

/// The two triangles of a quad, counter-clockwise.
void add_pair(TriangleMesh& mesh, std::array<std::uint32_t, 4> corners, std::uint16_t material) {
  add_triangle(mesh, {corners[0], corners[1], corners[2]}, material);
  add_triangle(mesh, {corners[0], corners[2], corners[3]}, material);
}

/// How many textures fit on a length.
float repeats(float length_m, const Cover& cover) {
  return cover.texture_edge_m > 0.0F ? length_m / cover.texture_edge_m : 1.0F;
}

/// How many whole ones fit round a girth, so that the seam does not show.
float whole_repeats(float girth_m, const Cover& cover) {
  return std::max(1.0F, std::round(repeats(girth_m, cover)));
}

/// Two directions square to a third, which they turn round counter-clockwise.
std::array<Vector3f, 2> square_to(const Vector3f& axis) {
  const Vector3f other = std::abs(axis.z()) < 0.9F ? Vector3f::UnitZ() : Vector3f::UnitX();
  const Vector3f first = other.cross(axis).normalized();
  return {first, axis.cross(first)};
}

/// The points of a circle, each once.
std::vector<Vector3f> circle(const Vector3f& middle_m,
                             const std::array<Vector3f, 2>& directions,
                             float radius_m,
                             int sides) {
  std::vector<Vector3f> points;
  for (int i = 0; i < sides; ++i) {
    const float angle = 2.0F * kPi * static_cast<float>(i) / static_cast<float>(sides);
    points.push_back(
        middle_m + radius_m * (std::cos(angle) * directions[0] + std::sin(angle) * directions[1]));
  }
  return points;
}

/// Adds the points of a ring, the first once more at its end, and gives the first's index.
std::uint32_t add_ring(TriangleMesh& mesh,
                       const std::vector<Vector3f>& points,
                       float repeats_round,
                       float v) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
  const float step = repeats_round / static_cast<float>(points.size());
  for (std::size_t i = 0; i <= points.size(); ++i) {
    add_vertex(mesh, points[i % points.size()], {step * static_cast<float>(i), v});
  }
  return first;
}

/// Quads between two rings of as many points, the upper one seen above from outside.
void join_rings(
    TriangleMesh& mesh, std::uint32_t lower, std::uint32_t upper, int sides, const Cover& cover) {
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(sides); ++i) {
    add_pair(mesh, {lower + i, lower + i + 1, upper + i + 1, upper + i}, cover.material);
  }
}

/// Triangles from a ring to a point above it (or below, if `below`).
void join_tip(TriangleMesh& mesh,
              std::uint32_t ring,
              std::uint32_t tip,
              std::pair<int, bool> sides_and_below,
              const Cover& cover) {
  const auto [sides, below] = sides_and_below;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(sides); ++i) {
    if (below) {
      add_triangle(mesh, {ring + i + 1, ring + i, tip}, cover.material);
    } else {
      add_triangle(mesh, {ring + i, ring + i + 1, tip}, cover.material);
    }
  }
}

/// The lid of a tube: the same points with places in the texture of their own.
void add_lid(TriangleMesh& mesh,
             const std::vector<Vector3f>& points,
             const Vector3f& middle_m,
             bool below,
             const Cover& cover) {
  const std::uint32_t ring = add_ring(mesh, points, 1.0F, 0.0F);
  const float radius_m = (points.front() - middle_m).norm();
  const std::uint32_t tip = add_vertex(mesh, middle_m, {0.5F, repeats(radius_m, cover)});
  join_tip(mesh, ring, tip, {static_cast<int>(points.size()), below}, cover);
}

/// A place on the unit ball: the angle from its lower pole and round the upright axis.
Vector3f on_ball(float rise_rad, float turn_rad) {
  return {std::sin(rise_rad) * std::cos(turn_rad),
          std::sin(rise_rad) * std::sin(turn_rad),
          -std::cos(rise_rad)};
}

}  // namespace

void add_quad(TriangleMesh& mesh, const std::array<Vector3f, 4>& corners_m, const Cover& cover) {
  const float u = repeats((corners_m[1] - corners_m[0]).norm(), cover);
  const float v = repeats((corners_m[3] - corners_m[0]).norm(), cover);
  const std::uint32_t first = add_vertex(mesh, corners_m[0], {0.0F, v});
  add_vertex(mesh, corners_m[1], {u, v});
  add_vertex(mesh, corners_m[2], {u, 0.0F});
  add_vertex(mesh, corners_m[3], {0.0F, 0.0F});
  add_pair(mesh, {first, first + 1, first + 2, first + 3}, cover.material);
}

void add_box(TriangleMesh& mesh, const BoxShape& box, const Cover& cover) {
  const float c = std::cos(box.yaw_rad);
  const float s = std::sin(box.yaw_rad);
  const Vector3f x = 0.5F * box.size_m.x() * Vector3f(c, s, 0.0F);
  const Vector3f y = 0.5F * box.size_m.y() * Vector3f(-s, c, 0.0F);
  const Vector3f z = 0.5F * box.size_m.z() * Vector3f::UnitZ();
  const auto corner = [&](int i, int j, int k) -> Vector3f {
    return box.middle_m + (2 * i - 1) * x + (2 * j - 1) * y + (2 * k - 1) * z;
  };
  add_quad(mesh, {corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1)}, cover);
  add_quad(mesh, {corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1)}, cover);
  add_quad(mesh, {corner(1, 1, 0), corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1)}, cover);
  add_quad(mesh, {corner(0, 1, 0), corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1)}, cover);
  add_quad(mesh, {corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)}, cover);
  add_quad(mesh, {corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0), corner(0, 0, 0)}, cover);
}

void add_prism(TriangleMesh& mesh, const PrismShape& prism, const Cover& cover) {
  const float c = std::cos(prism.yaw_rad);
  const float s = std::sin(prism.yaw_rad);
  const auto place = [&](const Vector2f& p, float aside_m) -> Vector3f {
    return prism.middle_m + Vector3f(c * p.x() - s * aside_m, s * p.x() + c * aside_m, p.y());
  };
  const auto uv = [&](const Vector2f& p) -> Vector2f {
    return {repeats(p.x(), cover), -repeats(p.y(), cover)};
  };
  const float half_m = 0.5F * prism.width_m;
  const std::size_t count = prism.outline_m.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vector2f& from = prism.outline_m[i];
    const Vector2f& to = prism.outline_m[(i + 1) % count];
    add_quad(mesh,
             {place(from, -half_m), place(from, half_m), place(to, half_m), place(to, -half_m)},
             cover);
  }
  for (const float aside_m : {-half_m, half_m}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    for (const Vector2f& p : prism.outline_m) {
      add_vertex(mesh, place(p, aside_m), uv(p));
    }
    for (std::uint32_t i = 1; i + 1 < static_cast<std::uint32_t>(count); ++i) {
      const std::uint32_t last = first + i + 1;
      add_triangle(
          mesh,
          aside_m < 0.0F ? std::array{first, first + i, last} : std::array{first, last, first + i},
          cover.material);
    }
  }
}

void add_tube(TriangleMesh& mesh, const TubeShape& tube, const Cover& cover) {
  const Vector3f along = tube.to_m - tube.from_m;
  const auto directions = square_to(along.normalized());
  const auto lower = circle(tube.from_m, directions, tube.from_radius_m, tube.sides);
  const float round = whole_repeats(2.0F * kPi * tube.from_radius_m, cover);
  const float v = repeats(along.norm(), cover);
  const std::uint32_t lower_ring = add_ring(mesh, lower, round, v);
  if (tube.to_radius_m > 0.0F) {
    const auto upper = circle(tube.to_m, directions, tube.to_radius_m, tube.sides);
    join_rings(mesh, lower_ring, add_ring(mesh, upper, round, 0.0F), tube.sides, cover);
    add_lid(mesh, upper, tube.to_m, false, cover);
  } else {
    const std::uint32_t tip = add_vertex(mesh, tube.to_m, {0.5F * round, 0.0F});
    join_tip(mesh, lower_ring, tip, {tube.sides, false}, cover);
  }
  add_lid(mesh, lower, tube.from_m, true, cover);
}

void add_rock(TriangleMesh& mesh,
              const EllipsoidShape& ball,
              float roughness,
              std::uint64_t seed,
              const Cover& cover) {
  RandomNumbers random(seed);
  const float widest_m = ball.radius_m.head<2>().maxCoeff();
  const float round = whole_repeats(2.0F * kPi * widest_m, cover);
  const float high = repeats(kPi * ball.radius_m.maxCoeff(), cover);
  const auto point = [&](float rise_rad, float turn_rad) -> Vector3f {
    const float swell = 1.0F + random.uniform(-roughness, roughness);
    return ball.middle_m + swell * on_ball(rise_rad, turn_rad).cwiseProduct(ball.radius_m);
  };
  std::uint32_t below = add_vertex(mesh, point(0.0F, 0.0F), {0.5F * round, high});
  for (int ring = 1; ring < ball.rings; ++ring) {
    const float rise = static_cast<float>(ring) / static_cast<float>(ball.rings);
    std::vector<Vector3f> points;
    for (int i = 0; i < ball.sides; ++i) {
      const float turn = static_cast<float>(i) / static_cast<float>(ball.sides);
      points.push_back(point(kPi * rise, 2.0F * kPi * turn));
    }
    const std::uint32_t here = add_ring(mesh, points, round, high * (1.0F - rise));
    if (ring == 1) {
      join_tip(mesh, here, below, {ball.sides, true}, cover);
    } else {
      join_rings(mesh, below, here, ball.sides, cover);
    }
    below = here;
  }
  const std::uint32_t top = add_vertex(mesh, point(kPi, 0.0F), {0.5F * round, 0.0F});
  join_tip(mesh, below, top, {ball.sides, false}, cover);
}

void add_ellipsoid(TriangleMesh& mesh, const EllipsoidShape& ball, const Cover& cover) {
  add_rock(mesh, ball, 0.0F, 0, cover);
}

void add_leaf(TriangleMesh& mesh, const LeafShape& leaf, float uv_edge, std::uint16_t material) {
  const Vector2f uv = leaf.uv;
  const Vector2f u = Vector2f(uv_edge, 0.0F);
  const Vector2f v = Vector2f(0.0F, uv_edge);
  const std::uint32_t first = add_vertex(mesh, leaf.middle_m - leaf.along_m, uv);
  add_vertex(mesh, leaf.middle_m + leaf.aside_m, uv + u);
  add_vertex(mesh, leaf.middle_m + leaf.along_m, uv + u + v);
  add_vertex(mesh, leaf.middle_m - leaf.aside_m, uv + v);
  add_pair(mesh, {first, first + 1, first + 2, first + 3}, material);
}

void add_ground(TriangleMesh& mesh,
                const GroundShape& ground,
                const std::function<float(float, float)>& height_m,
                const Cover& cover) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
  const Vector2f size_m = ground.to_m - ground.from_m;
  for (int j = 0; j <= ground.cells_y; ++j) {
    for (int i = 0; i <= ground.cells_x; ++i) {
      const Vector2f share(static_cast<float>(i) / static_cast<float>(ground.cells_x),
                           static_cast<float>(j) / static_cast<float>(ground.cells_y));
      const Vector2f at = ground.from_m + share.cwiseProduct(size_m);
      const Vector2f uv(share.x() * repeats(size_m.x(), cover),
                        -share.y() * repeats(size_m.y(), cover));
      add_vertex(mesh, {at.x(), at.y(), height_m(at.x(), at.y())}, uv);
    }
  }
  const auto row = static_cast<std::uint32_t>(ground.cells_x + 1);
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(ground.cells_y); ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t at = first + j * row + i;
      add_pair(mesh, {at, at + 1, at + row + 1, at + row}, cover.material);
    }
  }
}

}  // namespace skyhalo
