#include "skyhalo/evaluation/thesis_table.hpp"

#include <algorithm>
#include <array>

namespace skyhalo {
namespace {

struct Row {
  std::string_view sequence;
  Metrics metrics;
};

constexpr std::array kTable81{
    Row{"0000", {8476, 6341, 508263, 4920, 0.979, 0.572, 0.633, 0.988, 0.990, 0.089, 0.513}},
    Row{"0001", {28266, 16866, 4154740, 24128, 0.990, 0.626, 0.539, 0.996, 0.994, 0.081, 0.493}},
    Row{"0002", {14267, 4220, 766715, 6798, 0.986, 0.772, 0.667, 0.995, 0.991, 0.081, 0.591}},
    Row{"0003", {17995, 5544, 843943, 12518, 0.979, 0.764, 0.590, 0.993, 0.985, 0.084, 0.534}},
    Row{"0004", {35287, 9108, 5974393, 29212, 0.994, 0.795, 0.547, 0.998, 0.995, 0.076, 0.540}},
    Row{"0005", {32727, 12073, 2265772, 25228, 0.984, 0.758, 0.599, 0.995, 0.989, 0.080, 0.553}},
    Row{"0006", {7344, 2540, 902593, 2723, 0.994, 0.742, 0.730, 0.997, 0.997, 0.074, 0.633}},
    Row{"0007", {51549, 22196, 15274112, 52143, 0.995, 0.699, 0.497, 0.999, 0.997, 0.074, 0.521}},
    Row{"0008", {55472, 13000, 6488300, 43228, 0.991, 0.810, 0.562, 0.998, 0.993, 0.076, 0.560}},
    Row{"0009", {13759, 7172, 2368631, 10438, 0.993, 0.657, 0.569, 0.997, 0.996, 0.086, 0.505}},
};

}  // namespace

std::optional<Metrics> thesis_row(std::string_view sequence) {
  const auto* const row = std::find_if(kTable81.begin(), kTable81.end(), [&](const Row& candidate) {
    return candidate.sequence == sequence;
  });
  return row == kTable81.end() ? std::nullopt : std::optional(row->metrics);
}

}  // namespace skyhalo
