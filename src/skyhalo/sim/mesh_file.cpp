#include "skyhalo/sim/mesh_file.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/sim/mesh_materials.hpp"

namespace skyhalo {
namespace {

void check_file(const std::filesystem::path& file, const MeshFileOptions& options) {
  if (!(options.unit_m > 0.0) || !std::isfinite(options.unit_m)) {
    throw input_error(
        file, "the unit must be greater than 0 m, got " + number_text("%g", options.unit_m));
  }
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    throw input_error(file, "there is no such file");
  }
  if (!std::filesystem::is_regular_file(file, ignored)) {
    throw input_error(file, "is no file; expected a mesh");
  }
}

/// The file's axes to the scene's.
Eigen::Matrix3d turned_up(UpAxis up) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (up == UpAxis::kY) {
    R << 0.0, 0.0, -1.0,  //
        -1.0, 0.0, 0.0,   //
        0.0, 1.0, 0.0;
  } else if (up == UpAxis::kX) {
    R << 0.0, 0.0, -1.0,  //
        0.0, 1.0, 0.0,    //
        1.0, 0.0, 0.0;
  }
  return R;
}

Eigen::Affine3d placed(const aiMatrix4x4& m) {
  Eigen::Affine3d T = Eigen::Affine3d::Identity();
  T.matrix().topRows<3>() << static_cast<double>(m.a1), static_cast<double>(m.a2),
      static_cast<double>(m.a3), static_cast<double>(m.a4), static_cast<double>(m.b1),
      static_cast<double>(m.b2), static_cast<double>(m.b3), static_cast<double>(m.b4),
      static_cast<double>(m.c1), static_cast<double>(m.c2), static_cast<double>(m.c3),
      static_cast<double>(m.c4);
  return T;
}

/// Throws where a face has a vertex that is not its mesh's; no step may look at it before.
void check_faces(const aiMesh& mesh, const std::filesystem::path& file) {
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices) {
        throw input_error(file,
                          "face " + std::to_string(i) + " of mesh \"" + mesh.mName.C_Str() +
                              "\": vertex " + std::to_string(face.mIndices[k]) +
                              ", but the mesh has " + std::to_string(mesh.mNumVertices));
      }
    }
  }
}

/// What the file holds, with polygons cut into triangles, and with no step that drops what is
/// invalid: that has to be told.
const aiScene& read_source(Assimp::Importer& importer, const std::filesystem::path& file) {
  const auto expect = [&](const aiScene* source) -> const aiScene& {
    if (source == nullptr) {
      throw input_error(file,
                        std::string("cannot be read as a mesh: ") + importer.GetErrorString());
    }
    return *source;
  };
  const aiScene& source = expect(importer.ReadFile(file.string(), 0));
  for (unsigned i = 0; i < source.mNumMeshes; ++i) {
    check_faces(*source.mMeshes[i], file);
  }
  return expect(importer.ApplyPostProcessing(aiProcess_Triangulate));
}

/// What a file is read into.
class MeshReader {
 public:
  MeshReader(Scene& scene, const aiScene& source, const std::filesystem::path& file)
      : scene_(scene), source_(source), file_(file), materials_(scene, source, file) {}

  /// Adds the meshes of a node and of those below it.
  void add(const aiNode& node, const Eigen::Affine3d& T_scene_parent) {
    const Eigen::Affine3d T_scene_node = T_scene_parent * placed(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      add(*source_.mMeshes[node.mMeshes[i]], T_scene_node);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      add(*node.mChildren[i], T_scene_node);
    }
  }

 private:
  void add(const aiMesh& mesh, const Eigen::Affine3d& T_scene_node) {
    TriangleMesh& whole = scene_.fixed;
    const auto first = static_cast<std::uint32_t>(whole.vertices_m.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& at = mesh.mVertices[i];
      if (!std::isfinite(at.x) || !std::isfinite(at.y) || !std::isfinite(at.z)) {
        throw input_error(file_,
                          "vertex " + std::to_string(i) + " of mesh \"" + mesh.mName.C_Str() +
                              "\": a coordinate is not finite");
      }
      const Eigen::Vector3d point = Eigen::Vector3f(at.x, at.y, at.z).cast<double>();
      whole.vertices_m.push_back((T_scene_node * point).cast<float>());
      whole.uvs.push_back(place_in_texture(mesh, i));
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices == 3) {  // points and lines have no surface
        whole.triangles.push_back(
            {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
        whole.materials.push_back(materials_.of(mesh, face));
      }
    }
  }

  /// With v down, as textures have it; zero where there is none.
  static Eigen::Vector2f place_in_texture(const aiMesh& mesh, unsigned vertex) {
    if (!mesh.HasTextureCoords(0)) {
      return Eigen::Vector2f::Zero();
    }
    const aiVector3D& uv = mesh.mTextureCoords[0][vertex];
    return {std::isfinite(uv.x) ? uv.x : 0.0F, std::isfinite(uv.y) ? 1.0F - uv.y : 0.0F};
  }

  Scene& scene_;
  const aiScene& source_;
  const std::filesystem::path& file_;
  MeshMaterials materials_;
};

}  // namespace

Scene read_scene(const std::filesystem::path& file, const MeshFileOptions& options) {
  check_file(file, options);
  Assimp::Importer importer;
  const aiScene& source = read_source(importer, file);
  Scene scene;
  scene.name = file.stem().string();
  if (source.mRootNode != nullptr) {
    Eigen::Affine3d T_scene_file = Eigen::Affine3d::Identity();
    T_scene_file.linear() = options.unit_m * turned_up(options.up);
    MeshReader(scene, source, file).add(*source.mRootNode, T_scene_file);
  }
  check(scene.fixed, file.string());
  return scene;
}

}  // namespace skyhalo
