#pragma once

#include <cstdint>

#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/map/local_map.hpp"
#include "skyhalo/map/range_scan.hpp"
#include "skyhalo/map/scan_rays.hpp"
#include "skyhalo/map/scan_sweep.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {

/// How a scan enters a map.
enum class IntegrationMethod {
  kAuto,   ///< the one that is likely cheaper for this scan and map
  kRays,   ///< along one ray per direction (Amanatides and Woo 1987; the thesis's way)
  kSweep,  ///< every cell looks up its direction: no holes between rays
};

struct IntegrationConfig {
  SensorModelConfig sensor;
  int limit_units = 5000;  ///< log odds stay within +- this many units, in [1, 32767]
  IntegrationMethod method = IntegrationMethod::kAuto;
  bool cell_size_term = true;  ///< sweep: a surface marks all cells that it touches, not only those
                               ///< whose middle is as near to it as the sensor is exact
};

/// What a scan did.
struct IntegrationReport {
  IntegrationMethod used = IntegrationMethod::kSweep;
  int things = 0;           ///< directions with a range
  int free = 0;             ///< directions that are free without one
  std::int64_t bricks = 0;  ///< that were asked to change
};

/// Enters scans into maps of any kind (thesis 6.2, 7.1, 7.2.2). Each cell changes at most once per
/// scan, by the `stronger` of all that the scan says of it: its own free rays do not erase its
/// hits. Directions that are unseen change nothing. Owns all memory that a scan needs. The same
/// bits at any number of threads; not for use by two threads at once.
class ScanIntegrator {
 public:
  /// Throws `Error` (input) when a setting is outside its domain.
  explicit ScanIntegrator(const IntegrationConfig& config);

  /// Enters one scan, taken from the body's origin. A pose that is not finite or beyond the cells
  /// that can be numbered changes nothing, nor does any scan cells beyond `kMostReachCells`. A
  /// sparse map may throw `std::bad_alloc`; what it holds then is part of the scan.
  template <class Map>  // DenseMap, LocalMap or SparseMap
  IntegrationReport integrate(const RangeScan& scan, const Pose& T_map_body, Map& map);

  [[nodiscard]] const IntegrationConfig& config() const noexcept { return config_; }

 private:
  template <class Map>
  void run_jobs(Map& map);
  template <class Map>
  void apply_marks(Map& map);

  ScanSweep sweep_;  // first, as it has room for vectors
  ScanRays rays_;
  IncrementTable table_;
  IntegrationConfig config_;
};

/// Throws `Error` (input) naming the key when a setting is outside its domain.
void check(const IntegrationConfig& config);

}  // namespace skyhalo
