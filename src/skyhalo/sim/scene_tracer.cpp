#include "skyhalo/sim/scene_tracer.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

constexpr std::size_t kPacket = 8;

/// Releases Embree's objects, each in its own way.
struct Release {
  void operator()(RTCDevice device) const noexcept { rtcReleaseDevice(device); }

  void operator()(RTCScene scene) const noexcept { rtcReleaseScene(scene); }

  void operator()(RTCGeometry geometry) const noexcept { rtcReleaseGeometry(geometry); }
};

using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release>;
using Tree = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release>;
using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Release>;

void expect_no_error(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) {
    throw Error(ErrorKind::kFailure,
                "ray tracer: Embree gave error " + std::to_string(error) +
                    (error == RTC_ERROR_OUT_OF_MEMORY ? " (out of memory)" : ""));
  }
}

template <class Item>
void fill(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::span<const Item> items) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Item), items.size());
  if (buffer == nullptr) {
    throw Error(ErrorKind::kFailure, "ray tracer: not enough memory for the scene");
  }
  std::copy(items.begin(), items.end(), static_cast<Item*>(buffer));
}

Tree tree_of(RTCDevice device, const TriangleMesh& mesh) {
  Tree tree(rtcNewScene(device));
  rtcSetSceneFlags(tree.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(tree.get(), RTC_BUILD_QUALITY_HIGH);
  const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  fill<Eigen::Vector3f>(geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices_m);
  fill<std::array<std::uint32_t, 3>>(
      geometry.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(tree.get(), geometry.get());
  rtcCommitScene(tree.get());
  expect_no_error(device);
  return tree;
}

/// Embree's 3 x 4 matrix, column by column.
using Columns = std::array<float, 12>;

Columns columns_of(const Pose& T) {
  const Eigen::Matrix<float, 3, 4> matrix = T.matrix().topRows<3>().cast<float>();
  Columns columns{};
  Eigen::Map<Eigen::Matrix<float, 3, 4>>(columns.data()) = matrix;
  return columns;
}

void attach_instance(RTCDevice device, RTCScene whole, RTCScene part, std::span<const Pose> at) {
  const Geometry instance(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(instance.get(), part);
  rtcSetGeometryTimeStepCount(instance.get(), static_cast<unsigned>(at.size()));
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Columns columns = columns_of(at[i]);
    rtcSetGeometryTransform(
        instance.get(), static_cast<unsigned>(i), RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
  }
  rtcCommitGeometry(instance.get());
  rtcAttachGeometry(whole, instance.get());
}

/// Eight rays in Embree's order; those beyond `count` are switched off by `valid`.
RTCRayHit8 packet_of(const SceneRay* rays,
                     std::size_t count,
                     float max_range_m,
                     std::array<int, kPacket>& valid) noexcept {
  RTCRayHit8 packet;  // NOLINT(*-member-init): what Embree reads is filled below
  for (std::size_t i = 0; i < kPacket; ++i) {
    const SceneRay& ray = rays[std::min(i, count - 1)];
    valid[i] = i < count && ray.direction.squaredNorm() > 0.5F ? -1 : 0;
    packet.ray.org_x[i] = ray.origin_m.x();
    packet.ray.org_y[i] = ray.origin_m.y();
    packet.ray.org_z[i] = ray.origin_m.z();
    packet.ray.dir_x[i] = ray.direction.x();
    packet.ray.dir_y[i] = ray.direction.y();
    packet.ray.dir_z[i] = ray.direction.z();
    packet.ray.tnear[i] = 0.0F;
    packet.ray.tfar[i] = max_range_m;
    packet.ray.time[i] = ray.time;
    packet.ray.mask[i] = ~0U;
    packet.ray.id[i] = 0;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  return packet;
}

}  // namespace

struct SceneTracer::Trees {
  Device device;
  Tree fixed;
  std::vector<Tree> movers;
};

struct SceneMoment::Placed {
  Tree tree;
  std::vector<Eigen::Matrix3f> R_scene_object;  // in the middle of the span; the fixed ones first
};

SceneTracer::SceneTracer(const Scene& scene) : scene_(scene), trees_(std::make_unique<Trees>()) {
  check(scene);
  trees_->device.reset(rtcNewDevice(nullptr));
  if (!trees_->device) {
    throw Error(ErrorKind::kFailure, "ray tracer: Embree does not start on this machine");
  }
  trees_->fixed = tree_of(trees_->device.get(), scene.fixed);
  for (const MovingObject& mover : scene.movers) {
    trees_->movers.push_back(tree_of(trees_->device.get(), mover.mesh));
  }
}

SceneTracer::~SceneTracer() = default;

namespace {

/// What a search for the nearest triangle knows.
struct NearestSearch {
  const TriangleMesh* mesh;
  Eigen::Vector3f point_m;
  float nearest_m2;
};

/// The nearest point of a triangle (Ericson 2005, 5.1.5).
Eigen::Vector3f nearest_on_triangle(const Eigen::Vector3f& p,
                                    const Eigen::Vector3f& a,
                                    const Eigen::Vector3f& b,
                                    const Eigen::Vector3f& c) {
  const Eigen::Vector3f ab = b - a;
  const Eigen::Vector3f ac = c - a;
  const float d1 = ab.dot(p - a);
  const float d2 = ac.dot(p - a);
  if (d1 <= 0.0F && d2 <= 0.0F) {
    return a;
  }
  const float d3 = ab.dot(p - b);
  const float d4 = ac.dot(p - b);
  if (d3 >= 0.0F && d4 <= d3) {
    return b;
  }
  const float d5 = ab.dot(p - c);
  const float d6 = ac.dot(p - c);
  if (d6 >= 0.0F && d5 <= d6) {
    return c;
  }
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0F && d1 >= 0.0F && d3 <= 0.0F) {
    return a + ab * (d1 / (d1 - d3));
  }
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0F && d2 >= 0.0F && d6 <= 0.0F) {
    return a + ac * (d2 / (d2 - d6));
  }
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0.0F && d4 >= d3 && d5 >= d6) {
    return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  }
  const float sum = va + vb + vc;
  return sum > 0.0F ? Eigen::Vector3f(a + ab * (vb / sum) + ac * (vc / sum)) : a;
}

bool take_nearer(RTCPointQueryFunctionArguments* arguments) {
  auto& search = *static_cast<NearestSearch*>(arguments->userPtr);
  const auto& [a, b, c] = search.mesh->triangles[arguments->primID];
  const auto& vertices_m = search.mesh->vertices_m;
  const float m2 =
      (nearest_on_triangle(search.point_m, vertices_m[a], vertices_m[b], vertices_m[c]) -
       search.point_m)
          .squaredNorm();
  if (m2 >= search.nearest_m2) {
    return false;
  }
  search.nearest_m2 = m2;
  arguments->query->radius = std::sqrt(m2);
  return true;
}

}  // namespace

double SceneTracer::clearance_m(const Eigen::Vector3d& point_m, double max_m) const noexcept {
  const auto radius_m = static_cast<float>(max_m);
  NearestSearch search{&scene_.fixed, point_m.cast<float>(), radius_m * radius_m};
  RTCPointQuery query{};
  query.x = search.point_m.x();
  query.y = search.point_m.y();
  query.z = search.point_m.z();
  query.radius = radius_m;
  RTCPointQueryContext context{};
  rtcInitPointQueryContext(&context);
  const bool found = rtcPointQuery(trees_->fixed.get(), &query, &context, take_nearer, &search);
  return found ? std::sqrt(static_cast<double>(search.nearest_m2))
               : std::numeric_limits<double>::infinity();
}

SceneMoment::SceneMoment(const SceneTracer& tracer, const TimeSpan& span)
    : tracer_(tracer), span_(span) {
  const Scene& scene = tracer.scene();
  if (scene.movers.empty()) {
    return;
  }
  placed_ = std::make_unique<Placed>();
  const RTCDevice device = tracer.trees_->device.get();
  placed_->tree.reset(rtcNewScene(device));
  rtcSetSceneFlags(placed_->tree.get(), RTC_SCENE_FLAG_ROBUST);
  const std::array<Pose, 1> still{Pose::Identity()};
  attach_instance(device, placed_->tree.get(), tracer.trees_->fixed.get(), still);
  placed_->R_scene_object.emplace_back(Eigen::Matrix3f::Identity());
  for (std::size_t i = 0; i < scene.movers.size(); ++i) {
    const MovingObject& mover = scene.movers[i];
    const std::array<Pose, 2> ends{T_scene_object(mover, span.begin_s),
                                   T_scene_object(mover, span.end_s)};
    attach_instance(device, placed_->tree.get(), tracer.trees_->movers[i].get(), ends);
    placed_->R_scene_object.emplace_back(
        T_scene_object(mover, 0.5 * (span.begin_s + span.end_s)).linear().cast<float>());
  }
  rtcCommitScene(placed_->tree.get());
  expect_no_error(device);
}

SceneMoment::~SceneMoment() = default;

const Scene& SceneMoment::scene() const noexcept {
  return tracer_.scene();
}

void SceneMoment::trace(std::span<const SceneRay> rays,
                        std::span<SceneHit> hits,
                        float max_range_m) const noexcept {
  const RTCScene tree = placed_ ? placed_->tree.get() : tracer_.trees_->fixed.get();
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const std::size_t count = std::min(kPacket, rays.size() - first);
    alignas(32) std::array<int, kPacket> valid{};
    RTCRayHit8 packet = packet_of(rays.data() + first, count, max_range_m, valid);
    RTCIntersectContext context{};
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid.data(), tree, &context, &packet);
    for (std::size_t i = 0; i < count; ++i) {
      SceneHit& hit = hits[first + i];
      if (valid[i] == 0 || packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
        hit = {.range_m = std::numeric_limits<float>::infinity()};
        continue;
      }
      hit.range_m = packet.ray.tfar[i];
      hit.object = placed_ ? packet.hit.instID[0][i] : SceneHit::kFixed;
      hit.triangle = packet.hit.primID[i];
      hit.b = packet.hit.u[i];
      hit.c = packet.hit.v[i];
      Eigen::Vector3f normal(packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]);
      if (hit.object != SceneHit::kFixed) {
        normal = placed_->R_scene_object[hit.object] * normal;
      }
      const bool away = normal.dot(rays[first + i].direction) > 0.0F;
      hit.normal = normal * ((away ? -1.0F : 1.0F) / std::max(normal.norm(), 1e-30F));
    }
  }
}

SceneHit SceneMoment::trace(const SceneRay& ray, float max_range_m) const noexcept {
  SceneHit hit;
  trace(std::span(&ray, 1), std::span(&hit, 1), max_range_m);
  return hit;
}

}  // namespace skyhalo
