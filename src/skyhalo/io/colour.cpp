#include "skyhalo/io/colour.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace skyhalo {
namespace {

struct Rgb {
  double red;
  double green;
  double blue;
};

// Corner points chosen so that perceived lightness grows about linearly along the scale.
constexpr std::array<Rgb, 6> kStops{
    {{48, 18, 92}, {52, 75, 138}, {38, 122, 142}, {44, 166, 119}, {140, 206, 74}, {250, 230, 60}}};

unsigned char mix(double from, double to, double t) noexcept {
  return static_cast<unsigned char>(std::lround(from + (to - from) * t));
}

}  // namespace

cv::Vec3b scale_colour(double share) noexcept {
  const double s = share > 0.0 ? std::min(share, 1.0) : 0.0;  // NaN becomes 0
  const double position = s * (kStops.size() - 1);
  const auto stop = std::min(static_cast<std::size_t>(position), kStops.size() - 2);
  const double t = position - static_cast<double>(stop);
  const Rgb& a = kStops[stop];
  const Rgb& b = kStops[stop + 1];
  return {mix(a.blue, b.blue, t), mix(a.green, b.green, t), mix(a.red, b.red, t)};
}

}  // namespace skyhalo
