#include "skyhalo/safety/speed_limits.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/safety/speed_limits.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Integers = hn::RebindToSigned<Floats>;
using Vector = hn::Vec<Floats>;

constexpr float kInfinite = std::numeric_limits<float>::infinity();

HWY_INLINE Vector towards(const CellDirections& cells, int i, const Eigen::Vector3f& vector) {
  const Floats d;
  const Vector x = hn::Mul(hn::LoadU(d, cells.x + i), hn::Set(d, vector.x()));
  const Vector xy = hn::MulAdd(hn::LoadU(d, cells.y + i), hn::Set(d, vector.y()), x);
  return hn::MulAdd(hn::LoadU(d, cells.z + i), hn::Set(d, vector.z()), xy);
}

/// `1/sqrt(x)` to about four digits on every processor.
HWY_INLINE Vector reciprocal_root(Vector x) {
  const Floats d;
  const Vector first = hn::ApproximateReciprocalSqrt(x);
  const Vector half = hn::Mul(hn::Set(d, 0.5F), hn::Mul(x, first));
  return hn::Mul(first, hn::NegMulAdd(half, first, hn::Set(d, 1.5F)));
}

/// The speed s with `s delay + s^2/(2 brake) = distance` to a range (infinite for NaN); 0 where the
/// distance is not above 0.
HWY_INLINE Vector stopping_speed(Vector range_m, Vector brake_mps2, const Braking& braking) {
  const Floats d;
  const Vector zero = hn::Zero(d);
  const Vector share = hn::Set(d, std::max(0.0F, 1.0F - braking.cell_radius_rad));
  const Vector room_m = hn::Max(hn::MulSub(range_m, share, hn::Set(d, braking.keep_m)), zero);
  const Vector delay_mps = hn::Mul(brake_mps2, hn::Set(d, braking.delay_s));
  const Vector twice = hn::Mul(hn::Add(brake_mps2, brake_mps2), room_m);
  const Vector speed = hn::Sub(hn::Sqrt(hn::MulAdd(delay_mps, delay_mps, twice)), delay_mps);
  // Not by comparing for "unequal", which is no for NaN on some processors.
  return hn::IfThenElse(hn::Eq(range_m, range_m), hn::Max(speed, zero), hn::Set(d, kInfinite));
}

void limits_of_cells(const CellDirections& cells,
                     const CellRanges& ranges,
                     const Braking& braking,
                     const CellSpeeds& speeds) {
  const Floats d;
  const float horizontal = 1.0F / (braking.horizontal_mps2 * braking.horizontal_mps2);
  const float vertical = 1.0F / (braking.vertical_mps2 * braking.vertical_mps2);
  const Vector infinite = hn::Set(d, kInfinite);
  for (int i = 0; i < cells.count; i += static_cast<int>(hn::Lanes(d))) {
    const Vector up = towards(cells, i, braking.up_body);
    const Vector up2 = hn::Mul(up, up);
    const Vector level2 = hn::Sub(hn::Set(d, 1.0F), up2);
    const Vector brake_mps2 = reciprocal_root(
        hn::MulAdd(level2, hn::Set(d, horizontal), hn::Mul(up2, hn::Set(d, vertical))));
    const Vector depth_m = hn::LoadU(d, ranges.depths_m + i);
    const Vector free_m = hn::LoadU(d, ranges.free_to_m + i);
    hn::StoreU(stopping_speed(depth_m, brake_mps2, braking), d, speeds.thing_mps + i);
    const auto known = hn::Le(depth_m, free_m);
    Vector unseen = infinite;
    if (!hn::AllTrue(d, known)) {
      const Vector speed = hn::Max(stopping_speed(free_m, brake_mps2, braking),
                                   hn::Set(d, braking.unseen_speed_mps));
      unseen = hn::IfThenElse(known, infinite, speed);
    }
    hn::StoreU(unseen, d, speeds.unseen_mps + i);
  }
}

CellValue most_exceeded_cell(const CellDirections& cells,
                             const float* speeds_mps,
                             const Eigen::Vector3f& velocity_mps) {
  const Floats d;
  const Integers di;
  Vector most = hn::Set(d, -kInfinite);
  auto where = hn::Zero(di);
  for (int i = 0; i < cells.count; i += static_cast<int>(hn::Lanes(d))) {
    const Vector excess = hn::Sub(towards(cells, i, velocity_mps), hn::LoadU(d, speeds_mps + i));
    const auto more = hn::Gt(excess, most);
    most = hn::IfThenElse(more, excess, most);
    where = hn::IfThenElse(hn::RebindMask(di, more), hn::Iota(di, i), where);
  }
  HWY_ALIGN float values[hn::MaxLanes(d)];         // NOLINT(*-avoid-c-arrays)
  HWY_ALIGN std::int32_t places[hn::MaxLanes(d)];  // NOLINT(*-avoid-c-arrays)
  hn::Store(most, d, values);
  hn::Store(where, di, places);
  CellValue result{0, -kInfinite};
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    const bool first = values[lane] == result.value && places[lane] < result.cell;
    if (values[lane] > result.value || first) {
      result = {places[lane], values[lane]};
    }
  }
  return result;
}

CellValue least_share(const CellDirections& cells,
                      const float* speeds_mps,
                      const Eigen::Vector3f& velocity_mps,
                      float least_mps) {
  const Floats d;
  const Integers di;
  Vector least = hn::Set(d, 1.0F);
  auto where = hn::Set(di, -1);
  for (int i = 0; i < cells.count; i += static_cast<int>(hn::Lanes(d))) {
    const Vector approach = towards(cells, i, velocity_mps);
    const Vector share = hn::Div(hn::LoadU(d, speeds_mps + i), approach);
    const auto less = hn::And(hn::Ge(approach, hn::Set(d, least_mps)), hn::Lt(share, least));
    least = hn::IfThenElse(less, share, least);
    where = hn::IfThenElse(hn::RebindMask(di, less), hn::Iota(di, i), where);
  }
  HWY_ALIGN float values[hn::MaxLanes(d)];         // NOLINT(*-avoid-c-arrays)
  HWY_ALIGN std::int32_t places[hn::MaxLanes(d)];  // NOLINT(*-avoid-c-arrays)
  hn::Store(least, d, values);
  hn::Store(where, di, places);
  CellValue result{-1, 1.0F};
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    const bool first = values[lane] == result.value && places[lane] >= 0 &&
                       (result.cell < 0 || places[lane] < result.cell);
    if (values[lane] < result.value || first) {
      result = {places[lane], values[lane]};
    }
  }
  return result;
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo {

HWY_EXPORT(limits_of_cells);
HWY_EXPORT(most_exceeded_cell);
HWY_EXPORT(least_share);

void find_speed_limits(const CellDirections& cells,
                       const CellRanges& ranges,
                       const Braking& braking,
                       const CellSpeeds& speeds) noexcept {
  HWY_DYNAMIC_DISPATCH(limits_of_cells)(cells, ranges, braking, speeds);
}

CellValue most_exceeded(const CellDirections& cells,
                        const float* speeds_mps,
                        const Eigen::Vector3f& velocity_mps) noexcept {
  return HWY_DYNAMIC_DISPATCH(most_exceeded_cell)(cells, speeds_mps, velocity_mps);
}

CellValue allowed_share(const CellDirections& cells,
                        const float* speeds_mps,
                        const Eigen::Vector3f& velocity_mps,
                        float least_mps) noexcept {
  return HWY_DYNAMIC_DISPATCH(least_share)(cells, speeds_mps, velocity_mps, least_mps);
}

}  // namespace skyhalo
#endif
