#include <tbb/global_control.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/safety/velocity_limiter.hpp"
#include "skyhalo/sphere/accumulate.hpp"
#include "skyhalo/sphere/halo_query.hpp"

namespace {

using namespace skyhalo;  // NOLINT(google-build-using-namespace)

/// The fuzzer's bytes one after the other; 0 when there are no more.
class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  int next() {
    const int value = bytes_.empty() ? 0 : bytes_.front();
    bytes_ = bytes_.subspan(bytes_.empty() ? 0 : 1);
    return value;
  }

  int below(int end) { return next() % end; }

  /// From low to high in 256 steps.
  double between(double low, double high) { return low + (high - low) * next() / 255.0; }

  [[nodiscard]] std::span<const std::uint8_t> rest() const { return bytes_; }

 private:
  std::span<const std::uint8_t> bytes_;
};

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

Pose draw_mounting(Bytes& bytes) {
  const Eigen::Quaterniond q(bytes.between(-1.0, 1.0),
                             bytes.between(-1.0, 1.0),
                             bytes.between(-1.0, 1.0),
                             bytes.between(0.01, 1.0));
  return make_pose(q.normalized().toRotationMatrix(),
                   {bytes.between(-0.6, 0.6), bytes.between(-0.6, 0.6), bytes.between(-0.6, 0.6)});
}

PairGeometry draw_pair(Bytes& bytes, const cv::Size& size) {
  PairGeometry pair;
  const double u0 = bytes.between(-10.0, size.width + 10.0);
  const double v0 = bytes.between(-10.0, size.height + 10.0);
  if (bytes.below(2) == 0) {
    pair.model = PinholePair{
        bytes.between(0.5, 200.0), u0, v0, bytes.between(0.001, 2.0), bytes.between(-4.0, 4.0)};
  } else {
    pair.model = SphericalPair{
        bytes.between(0.001, 0.2), bytes.between(0.001, 0.3), u0, v0, bytes.between(0.001, 2.0)};
  }
  pair.T_body_camera = draw_mounting(bytes);
  pair.min_range_m = bytes.between(0.0, 2.0);
  pair.max_range_m = bytes.between(0.0, 60.0);
  return pair;
}

DepthRule draw_rule(Bytes& bytes) {
  constexpr DepthRuleKind kKinds[] = {// NOLINT(*-avoid-c-arrays)
                                      DepthRuleKind::kThesis,
                                      DepthRuleKind::kMean,
                                      DepthRuleKind::kNearest,
                                      DepthRuleKind::kQuantile};
  return {.kind = kKinds[bytes.below(4)],
          .sigma_threshold_m = bytes.between(0.0, 3.0),
          .sigma_factor = bytes.between(0.0, 5.0),
          .nearest_count = bytes.below(10),
          .quantile = bytes.between(-0.01, 1.0),
          .min_range_m = bytes.between(0.0, 1.0)};
}

/// Any bits as floats, again and again, with plain disparities among them.
cv::Mat1f draw_disparity(const cv::Size& size, std::span<const std::uint8_t> bytes) {
  cv::Mat1f disparity(size);
  std::size_t at = 0;
  for (float& value : disparity) {
    if (bytes.size() < sizeof(float)) {
      value = std::numeric_limits<float>::quiet_NaN();
    } else if (at % 3 == 0) {
      std::memcpy(&value, bytes.data() + at % (bytes.size() - 3), sizeof(float));
    } else {
      value = static_cast<float>(bytes[at % bytes.size()]) / 4.0F;
    }
    at += 5;
  }
  return disparity;
}

void check_ranges(std::span<const float> depths_m, std::span<const float> free_to_m) {
  for (std::size_t i = 0; i < depths_m.size(); ++i) {
    require(std::isnan(depths_m[i]) || (depths_m[i] >= 0.0F && std::isfinite(depths_m[i])));
    require(free_to_m[i] >= 0.0F && !(free_to_m[i] > depths_m[i]));
  }
}

void look_and_limit(Bytes& bytes, const Halo& halo) {
  const Eigen::Vector3d way(
      bytes.between(-3.0, 3.0), bytes.between(-3.0, 3.0), bytes.between(-3.0, 3.0));
  const TubeView tube = view_along_tube(
      halo, {.direction_body = way, .radius_m = bytes.between(0.0, 2.0), .distance_m = 20.0});
  require(tube.clear_to_m >= 0.0 && tube.clear_to_m <= 20.0);
  require(view_in_cone(halo, way, bytes.between(0.0, 4.0)).cells >= 0);
  const Pose body = draw_mounting(bytes);
  require(ring_of(halo, {-0.2, bytes.between(-0.2, 0.5)}, body.linear())[0].cells >= 0);
  constexpr UnseenPolicy kPolicies[] = {// NOLINT(*-avoid-c-arrays)
                                        UnseenPolicy::kBlock,
                                        UnseenPolicy::kSlow,
                                        UnseenPolicy::kAllow};
  VelocityLimiter limiter({.radius_m = bytes.between(0.01, 2.0),
                           .margin_m = bytes.between(0.0, 1.0),
                           .brake_mps2 = bytes.between(0.1, 10.0),
                           .brake_vertical_mps2 = bytes.between(0.1, 10.0),
                           .delay_s = bytes.between(0.0, 2.0),
                           .unseen = kPolicies[bytes.below(3)],
                           .look_angle_rad = bytes.between(0.0, 1.57),
                           .avoidance = bytes.below(2) == 0 ? Avoidance::kSlide : Avoidance::kStop},
                          halo);
  const Eigen::Vector3d velocity_mps = 4.0 * way.reverse();
  const Motion motion{4.0 * way, velocity_mps, body.linear()};
  const VelocityLimit limit = limiter.limit(halo, motion);
  require(limit.velocity_mps.allFinite());
  require(limit.velocity_mps.norm() <= motion.desired_mps.norm() + 2e-3);
}

void run(Bytes& bytes) {
  constexpr double kSteps_deg[] = {30.0, 10.0, 6.0, 7.0};  // NOLINT(*-avoid-c-arrays)
  const cv::Size size(1 + bytes.below(70), 1 + bytes.below(40));
  const double step_rad = rad_from_deg(kSteps_deg[bytes.below(4)]);
  const PairGeometry pair = draw_pair(bytes, size);
  const GridBounds bounds{
      0.0, rad_from_deg(180.0), rad_from_deg(-180.0), rad_from_deg(180.0), step_rad};
  const GridGeometry geometry = grid_of_view(pair, size, bounds, 0.5);
  const DepthRule rule = draw_rule(bytes);
  SphericalGrid grid(geometry, rule);
  Accumulator accumulator(pair,
                          size,
                          geometry,
                          rule,
                          {.near_m = bytes.between(0.2, 3.0),
                           .min_share = bytes.between(0.01, 1.0),
                           .window_rad = bytes.between(0.0, 0.7)});
  const cv::Mat1f disparity = draw_disparity(size, bytes.rest());
  const PixelCounts counts = accumulator.accumulate(disparity, grid);
  require(counts.used <= counts.measured && counts.measured <= size.area());
  check_ranges(grid.depths_m(), grid.free_to_m());
  Halo halo(step_rad);
  const std::vector<PairGrid> grids{{&grid, Timestamp()}, {}};
  halo.stitch(grids);
  check_ranges(halo.depths_m(), halo.free_to_m());
  look_and_limit(bytes, halo);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  Bytes reader({bytes, size});
  try {
    run(reader);
  } catch (const skyhalo::Error&) {
    return 0;
  }
  return 0;
}
