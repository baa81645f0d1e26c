// The nodes of a pyramid of patches. Compiled again for each instruction set: include it
// after Highway's foreach_target.h.
#if defined(SKYHALO_GATHER_NODES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SKYHALO_GATHER_NODES_INL
#undef SKYHALO_GATHER_NODES_INL
#else
#define SKYHALO_GATHER_NODES_INL
#endif

#include <hwy/highway.h>

#include <cmath>
#include <vector>

#include "skyhalo/geometry/arc_tangent-inl.hpp"
#include "skyhalo/map/float_vectors-inl.hpp"
#include "skyhalo/map/patch_pyramid.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// How 1/range of patches changes, as a part of it: per row and per column of directions.
HWY_INLINE Vector tilt_theta_of(Whole tilts) {
  const Vector whole = hn::ConvertTo(Floats(), hn::ShiftRight<16>(hn::ShiftLeft<16>(tilts)));
  return hn::Mul(whole, set(1.0F / 65536.0F));
}

HWY_INLINE Vector tilt_phi_of(Whole tilts) {
  return hn::Mul(hn::ConvertTo(Floats(), hn::ShiftRight<16>(tilts)), set(1.0F / 65536.0F));
}

/// The sum of a vector's components along the map's axes, without their signs: how far the places
/// of a cube of edge 2 are from its middle at most, along the vector.
HWY_INLINE Vector size_on_map(const Eigen::Matrix3f& R_map_body, Vector x, Vector y, Vector z) {
  return hn::Add(
      hn::Abs(rotated(R_map_body, 0, x, y, z)),
      hn::Add(hn::Abs(rotated(R_map_body, 1, x, y, z)), hn::Abs(rotated(R_map_body, 2, x, y, z))));
}

/// Stores the planes that touch one vector of patches in their middles. `col`: its first direction.
HWY_INLINE void store_planes(const ScanPatches& patches,
                             const DirectionRow& row,
                             std::size_t col,
                             Whole tilts,
                             PatchPyramid& pyramid) {
  const Floats d;
  PatchNodes& nodes = pyramid.nodes;
  const Vector per_theta = hn::Mul(tilt_theta_of(tilts), set(row.rows_per_rad));
  const Vector per_phi = hn::Mul(tilt_phi_of(tilts), set(row.rows_per_rad / row.sin_theta));
  const Vector sine = hn::LoadU(d, patches.sin_phi.data() + col);
  const Vector cosine = hn::LoadU(d, patches.cos_phi.data() + col);
  const Vector level = hn::MulAdd(per_theta, set(row.cos_theta), set(row.sin_theta));
  const Vector x = hn::NegMulAdd(per_phi, sine, hn::Mul(level, cosine));
  const Vector y = hn::MulAdd(per_phi, cosine, hn::Mul(level, sine));
  const Vector z = hn::NegMulAdd(per_theta, set(row.sin_theta), set(row.cos_theta));
  // By how much 1/range of a patch, which is linear in the angles, is off the plane's at its rim at
  // most: the next terms of Taylor's formula. And room for rounding.
  const float half_rad = 0.5F / row.rows_per_rad;
  const Vector steep_theta = hn::Abs(per_theta);
  const Vector steep_phi = hn::Abs(per_phi);
  const Vector along = hn::MulAdd(steep_theta, set(0.5F + half_rad), set(1.0F + half_rad));
  const Vector bend = hn::MulAdd(steep_phi, set(std::abs(row.cos_theta) + half_rad), along);
  const Vector steep = hn::Add(set(1.0F), hn::Add(steep_theta, steep_phi));
  const Vector off = hn::MulAdd(bend, set(half_rad * half_rad), hn::Mul(steep, set(2e-5F)));
  const Vector per_m = hn::LoadU(d, nodes.bend_per_m.data() + row.to + col);
  hn::StoreU(hn::Mul(x, per_m), d, nodes.x_per_m.data() + row.to + col);
  hn::StoreU(hn::Mul(y, per_m), d, nodes.y_per_m.data() + row.to + col);
  hn::StoreU(hn::Mul(z, per_m), d, nodes.z_per_m.data() + row.to + col);
  hn::StoreU(hn::Mul(off, per_m), d, nodes.bend_per_m.data() + row.to + col);
  hn::StoreU(hn::Mul(size_on_map(pyramid.R_map_body, x, y, z), per_m),
             d,
             nodes.size_per_m.data() + row.to + col);
}

/// A row of single directions.
void take_row(const ScanPatches& patches, const DirectionRow& row, PatchPyramid& pyramid) {
  const Floats d;
  PatchNodes& nodes = pyramid.nodes;
  const Vector one = set(1.0F);
  for (std::size_t col = 0; col < static_cast<std::size_t>(patches.cols); col += hn::Lanes(d)) {
    Vector near_m;
    Vector far_m;
    Vector z_m;
    Vector packed;
    hn::LoadInterleaved4(d, &patches.places[row.first + col].near_m, near_m, far_m, z_m, packed);
    const Whole tilts = hn::BitCast(Integers(), packed);
    const std::size_t at = row.to + col;
    const Vector per_m = reciprocal(z_m);
    hn::StoreU(near_m, d, nodes.near_m.data() + at);
    hn::StoreU(far_m, d, nodes.far_m.data() + at);
    // The margins that both limits have besides the patch's own ranges, as parts of these.
    const Vector rim =
        hn::Mul(set(0.5F), hn::Add(hn::Abs(tilt_theta_of(tilts)), hn::Abs(tilt_phi_of(tilts))));
    const Vector nearest_per_m = hn::Mul(hn::Add(one, rim), per_m);
    const Vector farthest_m = hn::Mul(z_m, reciprocal(hn::Sub(one, rim)));
    hn::StoreU(hn::NegMulAdd(near_m, nearest_per_m, one), d, nodes.before.data() + at);
    hn::StoreU(hn::Mul(hn::Sub(far_m, farthest_m), nearest_per_m), d, nodes.behind.data() + at);
    hn::StoreU(per_m, d, nodes.bend_per_m.data() + at);
    store_planes(patches, row, col, tilts, pyramid);
  }
}

/// Every second number, from the first or the second on.
template <int kSide>
HWY_INLINE Vector one_of_two(const float* values) {
  Vector first;
  Vector second;
  hn::LoadInterleaved2(Floats(), values, first, second);
  return kSide == 0 ? first : second;
}

/// The least, the most and the mean of four nodes' numbers: of two and two, in two rows.
HWY_INLINE Vector least_of_four(const float* above, const float* below) {
  return hn::Min(hn::Min(one_of_two<0>(above), one_of_two<1>(above)),
                 hn::Min(one_of_two<0>(below), one_of_two<1>(below)));
}

HWY_INLINE Vector most_of_four(const float* above, const float* below) {
  return hn::Max(hn::Max(one_of_two<0>(above), one_of_two<1>(above)),
                 hn::Max(one_of_two<0>(below), one_of_two<1>(below)));
}

HWY_INLINE Vector mean_of_four(const float* above, const float* below) {
  return hn::Mul(set(0.25F),
                 hn::Add(hn::Add(one_of_two<0>(above), one_of_two<1>(above)),
                         hn::Add(one_of_two<0>(below), one_of_two<1>(below))));
}

/// How far the patches of one vector of nodes, every second one from a side's on, are at most from
/// the planes of the nodes that they go into, at `to`: by what both planes differ in the node's
/// middle, and how fast that changes, besides their own.
template <int kSide>
HWY_INLINE Vector
bend_of(const PatchPyramid& pyramid, const NodeRow& row, std::size_t col, std::size_t to) {
  const Floats d;
  const PatchNodes& nodes = pyramid.nodes;
  const std::size_t from = row.first + 2 * col;
  const std::size_t column = row.first_column + 2 * col;
  const Vector x = hn::Sub(one_of_two<kSide>(nodes.x_per_m.data() + from),
                           hn::LoadU(d, nodes.x_per_m.data() + to));
  const Vector y = hn::Sub(one_of_two<kSide>(nodes.y_per_m.data() + from),
                           hn::LoadU(d, nodes.y_per_m.data() + to));
  const Vector z = hn::Sub(one_of_two<kSide>(nodes.z_per_m.data() + from),
                           hn::LoadU(d, nodes.z_per_m.data() + to));
  const Vector level = hn::MulAdd(x,
                                  one_of_two<kSide>(pyramid.cos_phi.data() + column),
                                  hn::Mul(y, one_of_two<kSide>(pyramid.sin_phi.data() + column)));
  const Vector middle =
      hn::Abs(hn::MulAdd(level, set(row.sin_theta), hn::Mul(z, set(row.cos_theta))));
  const Vector size = square_root(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))));
  const Vector apart = hn::MulAdd(size, set(row.extent_rad), middle);
  return hn::Add(one_of_two<kSide>(nodes.bend_per_m.data() + from), apart);
}

/// A row of nodes, from two rows of finer ones.
void gather_row(PatchPyramid& pyramid,
                const NodeRow& above,
                const NodeRow& below,
                std::size_t to,
                int columns) {
  const Floats d;
  PatchNodes& nodes = pyramid.nodes;
  for (std::size_t col = 0; col < static_cast<std::size_t>(columns); col += hn::Lanes(d)) {
    const std::size_t up = above.first + 2 * col;
    const std::size_t low = below.first + 2 * col;
    const std::size_t at = to + col;
    for (std::vector<float>* values : {&nodes.far_m, &nodes.before, &nodes.behind}) {
      float* const all = values->data();
      hn::StoreU(most_of_four(all + up, all + low), d, all + at);
    }
    for (std::vector<float>* values : {&nodes.x_per_m, &nodes.y_per_m, &nodes.z_per_m}) {
      float* const all = values->data();
      hn::StoreU(mean_of_four(all + up, all + low), d, all + at);
    }
    const Vector x = hn::LoadU(d, nodes.x_per_m.data() + at);
    const Vector y = hn::LoadU(d, nodes.y_per_m.data() + at);
    const Vector z = hn::LoadU(d, nodes.z_per_m.data() + at);
    hn::StoreU(size_on_map(pyramid.R_map_body, x, y, z), d, nodes.size_per_m.data() + at);
    float* const near_m = nodes.near_m.data();
    hn::StoreU(least_of_four(near_m + up, near_m + low), d, near_m + at);
    const Vector bend =
        hn::Max(hn::Max(bend_of<0>(pyramid, above, col, at), bend_of<1>(pyramid, above, col, at)),
                hn::Max(bend_of<0>(pyramid, below, col, at), bend_of<1>(pyramid, below, col, at)));
    hn::StoreU(bend, d, nodes.bend_per_m.data() + at);
  }
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
