#include "skyhalo/calibration/lens_words.hpp"

#include <algorithm>
#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

constexpr std::string_view kPinhole = "pinhole";
constexpr std::string_view kRadialTangential = "radial-tangential";
constexpr std::string_view kKannalaBrandt = "kannala-brandt";
constexpr std::string_view kDoubleSphere = "double-sphere";
constexpr std::string_view kExtendedUnified = "extended-unified";

void require_count(std::span<const double> numbers,
                   std::initializer_list<std::size_t> counts,
                   std::string_view meaning) {
  if (std::find(counts.begin(), counts.end(), numbers.size()) == counts.end()) {
    throw Error(ErrorKind::kInput,
                "distortion: expected " + std::string(meaning) + ", found " +
                    std::to_string(numbers.size()) + " numbers");
  }
}

template <class Coefficients>
Coefficients filled(std::span<const double> numbers) {
  Coefficients coefficients{};
  std::ranges::copy(numbers, coefficients.begin());
  return coefficients;
}

struct Words {
  std::string_view operator()(const RadialTangentialLens& lens) const noexcept {
    const auto& k = lens.distortion();
    return std::ranges::all_of(k, [](double x) { return x == 0.0; }) ? kPinhole : kRadialTangential;
  }

  std::string_view operator()(const KannalaBrandtLens&) const noexcept { return kKannalaBrandt; }

  std::string_view operator()(const DoubleSphereLens&) const noexcept { return kDoubleSphere; }

  std::string_view operator()(const ExtendedUnifiedLens&) const noexcept {
    return kExtendedUnified;
  }
};

struct Numbers {
  std::vector<double> operator()(const RadialTangentialLens& lens) const {
    const auto& k = lens.distortion();
    const auto all_zero_from = [&](std::size_t first) {
      return std::all_of(k.begin() + static_cast<std::ptrdiff_t>(first), k.end(), [](double x) {
        return x == 0.0;
      });
    };
    std::size_t count = k.size();
    for (const std::size_t fewer : {5U, 4U, 0U}) {
      count = all_zero_from(fewer) ? fewer : count;
    }
    return {k.begin(), k.begin() + static_cast<std::ptrdiff_t>(count)};
  }

  std::vector<double> operator()(const KannalaBrandtLens& lens) const {
    return {lens.distortion().begin(), lens.distortion().end()};
  }

  std::vector<double> operator()(const DoubleSphereLens& lens) const {
    return {lens.shape().xi, lens.shape().alpha};
  }

  std::vector<double> operator()(const ExtendedUnifiedLens& lens) const {
    return {lens.shape().alpha, lens.shape().beta};
  }
};

}  // namespace

std::string_view lens_word(const Lens& lens) noexcept {
  return ask(lens, Words{});
}

std::vector<double> distortion_numbers(const Lens& lens) {
  return std::visit(Numbers{}, lens);
}

Lens make_lens(std::string_view word,
               const Intrinsics& intrinsics,
               std::span<const double> distortion) {
  if (word == kPinhole) {
    require_count(distortion, {0}, "no numbers for a pinhole");
    return RadialTangentialLens(intrinsics, {});
  }
  if (word == kRadialTangential) {
    require_count(distortion, {4, 5, 8}, "4, 5 or 8 numbers k1 k2 p1 p2 [k3 [k4 k5 k6]]");
    return RadialTangentialLens(intrinsics, filled<RadialTangentialLens::Distortion>(distortion));
  }
  if (word == kKannalaBrandt) {
    require_count(distortion, {4}, "4 numbers k1 k2 k3 k4");
    return KannalaBrandtLens(intrinsics, filled<KannalaBrandtLens::Distortion>(distortion));
  }
  if (word == kDoubleSphere) {
    require_count(distortion, {2}, "2 numbers xi alpha");
    return DoubleSphereLens(intrinsics, {distortion[0], distortion[1]});
  }
  if (word == kExtendedUnified) {
    require_count(distortion, {2}, "2 numbers alpha beta");
    return ExtendedUnifiedLens(intrinsics, {distortion[0], distortion[1]});
  }
  throw Error(ErrorKind::kInput,
              "lens: expected pinhole, radial-tangential, kannala-brandt, double-sphere or "
              "extended-unified, found '" +
                  std::string(word) + "'");
}

}  // namespace skyhalo
