#pragma once

#include <assimp/scene.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// Brings the materials of a mesh file to a scene. What has no picture gets a fine grain by
/// position, so that a stereo camera sees something there.
class MeshMaterials {
 public:
  /// All materials of `source`, read from `file`. Both are kept by reference.
  ///
  /// Throws `Error` (input) naming the file and a texture that cannot be read, or that is named by
  /// an absolute path or one that leaves the file's folder.
  MeshMaterials(Scene& scene, const aiScene& source, const std::filesystem::path& file);

  /// The scene's material of a triangle: by the mean colour of its vertices where the mesh has
  /// colours, and else that of the mesh. The triangle's vertices are the mesh's.
  [[nodiscard]] std::uint16_t of(const aiMesh& mesh, const aiFace& triangle);

 private:
  void add_material(const aiMaterial& source);
  [[nodiscard]] std::uint16_t add(Material material);
  [[nodiscard]] int texture(const aiString& name);
  [[nodiscard]] int grain();
  void give_grain(Material& material, const Eigen::Vector3f& colour_bgr);

  Scene& scene_;
  const aiScene& source_;
  const std::filesystem::path& file_;
  std::vector<std::uint16_t> materials_;            // by the file's number
  std::map<std::uint32_t, std::uint16_t> colours_;  // by colour in 5 bits a channel
  std::map<std::uint16_t, std::uint16_t> grained_;  // pictured ones, for meshes without a place in
                                                    // the picture
  std::map<std::string, int> textures_;             // by the picture's name
  int grain_ = -1;
};

}  // namespace skyhalo
