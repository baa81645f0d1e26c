#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <span>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// A ray of the scene's frame.
struct SceneRay {
  Eigen::Vector3f origin_m;
  Eigen::Vector3f direction;  ///< unit vector; zero: no ray
  float time = 0.0F;          ///< share of the moment's span, 0...1
};

/// What a ray met first.
struct SceneHit {
  static constexpr std::uint32_t kNothing = ~std::uint32_t{0};
  static constexpr std::uint32_t kFixed = 0;

  float range_m = 0.0F;             ///< infinity: nothing
  std::uint32_t object = kNothing;  ///< `kFixed`, 1 + index of the mover, or `kNothing`
  std::uint32_t triangle = 0;       ///< of the object's mesh
  float b = 0.0F;                   ///< weight of the triangle's second vertex
  float c = 0.0F;                   ///< and of its third one
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< unit vector, towards the ray's origin
};

/// A span of time, short against what moves in it.
struct TimeSpan {
  double begin_s = 0.0;
  double end_s = 0.0;
};

class SceneTracer;

/// A scene during a span of time: movers go straight from where they are at its begin to where they
/// are at its end. Refers to its tracer, which must outlive it. May be asked by several threads.
class SceneMoment {
 public:
  SceneMoment(const SceneTracer& tracer, const TimeSpan& span);
  SceneMoment(const SceneMoment&) = delete;
  SceneMoment& operator=(const SceneMoment&) = delete;
  SceneMoment(SceneMoment&&) = delete;
  SceneMoment& operator=(SceneMoment&&) = delete;
  ~SceneMoment();

  /// The nearest hit of each ray within `max_range_m`; as many as rays.
  void trace(std::span<const SceneRay> rays,
             std::span<SceneHit> hits,
             float max_range_m = 1e6F) const noexcept;

  [[nodiscard]] SceneHit trace(const SceneRay& ray, float max_range_m = 1e6F) const noexcept;

  [[nodiscard]] const Scene& scene() const noexcept;

  [[nodiscard]] const TimeSpan& span() const noexcept { return span_; }

 private:
  struct Placed;

  const SceneTracer& tracer_;
  TimeSpan span_;
  std::unique_ptr<Placed> placed_;  // none where nothing moves
};

/// Finds what rays meet in a scene, which must outlive it (Embree).
class SceneTracer {
 public:
  /// Throws `Error` (input) as `check(scene)` does, and (failure) when memory is short.
  explicit SceneTracer(const Scene& scene);
  SceneTracer(const SceneTracer&) = delete;
  SceneTracer& operator=(const SceneTracer&) = delete;
  SceneTracer(SceneTracer&&) = delete;
  SceneTracer& operator=(SceneTracer&&) = delete;
  ~SceneTracer();

  [[nodiscard]] const Scene& scene() const noexcept { return scene_; }

  /// How far the nearest point of what stands still is from a point (m, scene); infinity when it
  /// is beyond `max_m`.
  [[nodiscard]] double clearance_m(const Eigen::Vector3d& point_m, double max_m) const noexcept;

 private:
  friend class SceneMoment;
  struct Trees;

  const Scene& scene_;
  std::unique_ptr<Trees> trees_;
};

}  // namespace skyhalo
