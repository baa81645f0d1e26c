#include "skyhalo/sim/triangle_mesh.hpp"

#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

constexpr float kReachM = 1e5F;

[[nodiscard]] Error fault(std::string_view name, const std::string& what) {
  return {ErrorKind::kInput, std::string(name) + ": " + what};
}

/// Gives every vertex a place in the texture, zero where it has none.
void place_all(TriangleMesh& mesh) {
  mesh.uvs.resize(mesh.vertices_m.size(), Eigen::Vector2f::Zero());
}

}  // namespace

void append(TriangleMesh& whole, const TriangleMesh& part, const Pose& T_whole_part) {
  const auto first = static_cast<std::uint32_t>(whole.vertices_m.size());
  const bool placed = !whole.uvs.empty() || !part.uvs.empty();
  for (const Eigen::Vector3f& vertex_m : part.vertices_m) {
    whole.vertices_m.push_back((T_whole_part * vertex_m.cast<double>()).cast<float>());
  }
  for (const auto& [a, b, c] : part.triangles) {
    whole.triangles.push_back({first + a, first + b, first + c});
  }
  whole.materials.insert(whole.materials.end(), part.materials.begin(), part.materials.end());
  if (placed) {
    whole.uvs.resize(first, Eigen::Vector2f::Zero());
    whole.uvs.insert(whole.uvs.end(), part.uvs.begin(), part.uvs.end());
    place_all(whole);
  }
}

Eigen::AlignedBox3d bounds_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex_m : mesh.vertices_m) {
    box.extend(vertex_m.cast<double>());
  }
  return box;
}

void check(const TriangleMesh& mesh, std::string_view name) {
  if (mesh.triangles.empty()) {
    throw fault(name, "holds no triangle");
  }
  for (std::size_t i = 0; i < mesh.vertices_m.size(); ++i) {
    // A comparison that NaN fails.
    if (!(mesh.vertices_m[i].cwiseAbs().maxCoeff() <= kReachM) || !mesh.vertices_m[i].allFinite()) {
      throw fault(name,
                  "vertex " + std::to_string(i) +
                      ": a coordinate is not finite or beyond 100 km from the origin");
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      if (vertex >= mesh.vertices_m.size()) {
        throw fault(
            name,
            "triangle " + std::to_string(i) + ": there is no vertex " + std::to_string(vertex));
      }
    }
  }
  if (mesh.materials.size() != mesh.triangles.size()) {
    throw fault(name, "each triangle needs one material");
  }
  if (!mesh.uvs.empty() && mesh.uvs.size() != mesh.vertices_m.size()) {
    throw fault(name, "each vertex or none needs a place in the texture");
  }
}

}  // namespace skyhalo
