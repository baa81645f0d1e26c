#pragma once

#include <cstddef>
#include <cstdint>

#include "skyhalo/stereo/sgm/plane.hpp"

namespace skyhalo::sgm {

/// What the census is taken of: an image and its two smoothed copies.
struct CensusImages {
  Plane<std::uint8_t> raw;
  Plane<std::uint8_t> cross;
  Plane<std::uint8_t> box;
};

/// Where the three bytes of a row's census go: `size` bytes are written at each, whole vectors.
struct CensusRow {
  std::uint8_t* near = nullptr;
  std::uint8_t* middle = nullptr;
  std::uint8_t* far = nullptr;
};

/// The census of row v (Zabih and Woodfill 1994), 24 bits a pixel: bit k of a byte tells whether
/// the k-th of eight neighbours, row by row, is darker than the centre. Near neighbours are 1 px
/// away in the raw image, middle ones 2 px in the cross-smoothed and far ones 4 px in the
/// box-smoothed one, each against the centre of the same image. Writes whole vectors: rows need
/// room behind.
void census_row(const CensusImages& images, int v, const CensusRow& out);

}  // namespace skyhalo::sgm
