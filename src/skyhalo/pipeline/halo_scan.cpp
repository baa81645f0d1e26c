#include "skyhalo/pipeline/halo_scan.hpp"

#include <cmath>

namespace skyhalo {

void fill_scan(const Halo& halo, std::span<const RangeModel> models, RangeScan& scan) noexcept {
  scan.clear();
  const GridGeometry& grid = halo.geometry();
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      const auto at = static_cast<std::size_t>(grid.offset_of({row, col}));
      const float z_m = halo.depths_m()[at];
      const std::size_t source = halo.sources()[at];
      if (std::isnan(z_m)) {
        scan.set_free(row, col, halo.free_to_m()[at]);
      } else if (source < models.size()) {
        const RangeModel& model = models[source];
        scan.set_depth(
            row, col, z_m, static_cast<float>(delta_z_m(model.pair, z_m, model.delta_d_px)));
      }
    }
  }
}

}  // namespace skyhalo
