#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "map_flight.hpp"
#include "skyhalo/map/occupancy.hpp"

namespace skyhalo::bench {

/// A map that takes part: ours of some kind with some method, or a peer's.
class Contender {
 public:
  explicit Contender(std::string name) : name_(std::move(name)) {}

  Contender(const Contender&) = delete;
  Contender& operator=(const Contender&) = delete;
  Contender(Contender&&) = delete;
  Contender& operator=(Contender&&) = delete;
  virtual ~Contender() = default;

  [[nodiscard]] const std::string& name() const noexcept { return name_; }

  /// A fresh map; not timed.
  virtual void reset() = 0;

  /// Enters one scan; timed.
  virtual void insert(const FlownScan& scan) = 0;

  /// What the map says of the cell at a point (m, map frame).
  [[nodiscard]] virtual Occupancy at(const Eigen::Vector3d& point_m) const = 0;

  [[nodiscard]] virtual std::size_t memory_bytes() const = 0;

 private:
  std::string name_;
};

/// Those for a map of a whole flight: OctoMap, and ours by all methods.
[[nodiscard]] std::vector<std::unique_ptr<Contender>> global_maps(const Flight& flight,
                                                                  double voxel_m);

/// Local maps of this size by all methods; entering a scan moves the map first.
[[nodiscard]] std::vector<std::unique_ptr<Contender>> local_maps(const Eigen::Vector3d& size_m,
                                                                 double voxel_m);

}  // namespace skyhalo::bench
