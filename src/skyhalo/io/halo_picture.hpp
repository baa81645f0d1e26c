#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "skyhalo/sphere/halo.hpp"
#include "skyhalo/sphere/halo_query.hpp"

namespace skyhalo {

/// The colour of a thing at this range (m) in the pictures of a halo: yellow at 1 m and nearer,
/// over green and blue to violet at 33 m and farther, in equal steps for equal factors. The scale
/// is the same in all pictures, so that frames compare.
[[nodiscard]] cv::Vec3b range_colour(double range_m) noexcept;

/// Where a picture of a halo has one colour for all cells of a kind.
struct HaloColours {
  static const cv::Vec3b kFree;    ///< seen, and nothing there: nearly white
  static const cv::Vec3b kUnseen;  ///< dark grey
  static const cv::Vec3b kPartly;  ///< before a thing, but not all of it seen; only from above
  static const cv::Vec3b kBeyond;  ///< behind a thing: middle grey, only from above
};

/// The whole sphere unrolled, as seen from the body: up is up, left is left, ahead is in the
/// middle. Things have their range's colour, free cells are nearly white, unseen ones dark grey. A
/// cell is a square of `cell_px`; thin lines mark the horizon and each 45 degrees of azimuth. Below
/// it are the azimuths and a legend.
[[nodiscard]] cv::Mat3b halo_picture(const Halo& halo, int cell_px);

/// The halo as a level ring (`ring_of`), seen from above: the nose's heading is up, left is left,
/// the body a triangle in the middle and `max_range_m` (> 0) the edge of the disc. A sector is
/// nearly white as far as all its cells in the band are free; the nearest thing in it is an edge in
/// its range's colour, and middle grey beyond. What is not known to be free is hatched: light where
/// a thing follows, but some cell was not seen all the way, and dark where none does. Rings mark
/// ranges. The picture has `size_px` (> 0) on a side.
[[nodiscard]] cv::Mat3b halo_top_picture(const Halo& halo,
                                         const PitchBand& pitch,
                                         const Eigen::Matrix3d& R_map_body,
                                         double max_range_m,
                                         int size_px);

}  // namespace skyhalo
