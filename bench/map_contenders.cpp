#include "map_contenders.hpp"

#include <octomap/OcTree.h>

#include <array>
#include <optional>
#include <utility>

#include "skyhalo/map/map_query.hpp"
#include "skyhalo/map/scan_integrator.hpp"

namespace skyhalo::bench {
namespace {

class OctoMapContender final : public Contender {
 public:
  explicit OctoMapContender(double voxel_m) : Contender("OctoMap"), voxel_m_(voxel_m) { reset(); }

  void reset() override {
    tree_.reset();  // first, so that only one is held
    tree_ = std::make_unique<octomap::OcTree>(voxel_m_);
  }

  void insert(const FlownScan& scan) override {
    const Eigen::Vector3f origin_m = scan.T_map_body.translation().cast<float>();
    tree_->insertPointCloud(
        scan.cloud, octomap::point3d(origin_m.x(), origin_m.y(), origin_m.z()), kRangeM);
  }

  [[nodiscard]] Occupancy at(const Eigen::Vector3d& point_m) const override {
    const octomap::OcTreeNode* node = tree_->search(point_m.x(), point_m.y(), point_m.z());
    if (node == nullptr) {
      return Occupancy::kNotKnown;
    }
    return tree_->isNodeOccupied(node) ? Occupancy::kOccupied : Occupancy::kFree;
  }

  [[nodiscard]] std::size_t memory_bytes() const override { return tree_->memoryUsage(); }

 private:
  double voxel_m_;
  std::unique_ptr<octomap::OcTree> tree_;
};

constexpr std::array kMethods{
    IntegrationMethod::kAuto, IntegrationMethod::kSweep, IntegrationMethod::kRays};

const char* name_of(IntegrationMethod method) {
  switch (method) {
    case IntegrationMethod::kRays:
      return "rays";
    case IntegrationMethod::kSweep:
      return "sweep";
    default:
      return "auto";
  }
}

/// `Make` gives a fresh map.
template <class Make>
class OurContender final : public Contender {
 public:
  using Map = decltype(std::declval<Make>()());

  OurContender(const std::string& map_name, IntegrationMethod method, Make make)
      : Contender(map_name + ", " + name_of(method)),
        make_(std::move(make)),
        integrator_({.sensor = {}, .method = method}),
        map_(make_()) {}

  void reset() override {
    map_.reset();  // first, so that only one is held
    map_.emplace(make_());
  }

  void insert(const FlownScan& scan) override {
    if constexpr (std::is_same_v<Map, LocalMap>) {
      map_->follow(scan.T_map_body.translation());
    }
    integrator_.integrate(scan.scan, scan.T_map_body, *map_);
  }

  [[nodiscard]] Occupancy at(const Eigen::Vector3d& point_m) const override {
    return occupancy(*map_, point_m);
  }

  [[nodiscard]] std::size_t memory_bytes() const override { return map_->memory_bytes(); }

 private:
  Make make_;
  ScanIntegrator integrator_;
  std::optional<Map> map_;
};

template <class Make>
void add_all_methods(const std::string& map_name,
                     const Make& make,
                     std::vector<std::unique_ptr<Contender>>& all) {
  for (const IntegrationMethod method : kMethods) {
    all.push_back(std::make_unique<OurContender<Make>>(map_name, method, make));
  }
}

}  // namespace

std::vector<std::unique_ptr<Contender>> global_maps(const Flight& flight, double voxel_m) {
  std::vector<std::unique_ptr<Contender>> all;
  // On the lattice that the others have: cell (0, 0, 0) begins at the origin.
  const Eigen::Vector3d min_cell = (flight.bounds_m.min() / voxel_m).array().round();
  const Eigen::Vector3d max_cell = (flight.bounds_m.max() / voxel_m).array().round();
  const VoxelGrid grid{min_cell * voxel_m, voxel_m, (max_cell - min_cell).cast<int>()};
  add_all_methods(
      "DenseMap", [grid] { return DenseMap(grid); }, all);
  add_all_methods(
      "SparseMap",
      [voxel_m] {
        return SparseMap(VoxelLattice{Eigen::Vector3d::Zero(), voxel_m});
      },
      all);
  all.push_back(std::make_unique<OctoMapContender>(voxel_m));
  return all;
}

std::vector<std::unique_ptr<Contender>> local_maps(const Eigen::Vector3d& size_m, double voxel_m) {
  std::vector<std::unique_ptr<Contender>> all;
  const Eigen::Vector3i cells = local_map_cells(size_m, voxel_m);
  add_all_methods(
      "LocalMap", [=] { return LocalMap(cells, voxel_m); }, all);
  return all;
}

}  // namespace skyhalo::bench
