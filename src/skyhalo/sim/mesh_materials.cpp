#include "skyhalo/sim/mesh_materials.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/sim/procedural_texture.hpp"

namespace skyhalo {
namespace {

constexpr float kGrainEdgeM = 2.0F;
constexpr float kGrainMean = 0.53F;  // brightness of the grain's picture
constexpr int kTones = 32;           // of a vertex colour's channel

[[nodiscard]] Error texture_error(const std::filesystem::path& file,
                                  const std::string& name,
                                  const std::string& what) {
  return input_error(file, "texture \"" + name + "\" " + what);
}

/// The place of a picture that the file names relative to itself.
std::filesystem::path picture_path(const std::filesystem::path& file, const std::string& name) {
  std::string forward = name;
  std::replace(forward.begin(), forward.end(), '\\', '/');
  const std::filesystem::path relative = std::filesystem::path(forward).lexically_normal();
  if (relative.is_absolute() || relative.empty() || *relative.begin() == "..") {
    throw texture_error(file, name, "lies outside of the file's folder");
  }
  return file.parent_path() / relative;
}

/// A picture in a file of its own; empty when it cannot be read.
cv::Mat3b picture_in(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
  return bytes.empty() ? cv::Mat3b() : cv::Mat3b(cv::imdecode(bytes, cv::IMREAD_COLOR));
}

/// A picture held in the file itself: packed as PNG or JPEG, or pixel by pixel.
cv::Mat3b embedded_picture(const aiTexture& texture) {
  if (texture.mHeight == 0) {
    const auto size = static_cast<int>(texture.mWidth);
    const cv::Mat1b bytes(1, size, reinterpret_cast<std::uint8_t*>(texture.pcData));
    return cv::imdecode(bytes, cv::IMREAD_COLOR);
  }
  cv::Mat3b picture(static_cast<int>(texture.mHeight), static_cast<int>(texture.mWidth));
  const aiTexel* texel = texture.pcData;
  for (cv::Vec3b& pixel : picture) {
    pixel = {texel->b, texel->g, texel->r};
    ++texel;
  }
  return picture;
}

cv::Mat3b picture_of(const aiScene& source,
                     const std::filesystem::path& file,
                     const std::string& name) {
  cv::Mat3b picture;
  try {
    const aiTexture* const embedded = source.GetEmbeddedTexture(name.c_str());
    picture =
        embedded != nullptr ? embedded_picture(*embedded) : picture_in(picture_path(file, name));
  } catch (const cv::Exception&) {
    picture.release();
  }
  if (picture.empty()) {
    throw texture_error(file, name, "cannot be read as a picture");
  }
  return picture;
}

float share(float value) {
  return std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 0.5F;
}

/// The colour of a material that has no picture, or that its picture is multiplied with.
Eigen::Vector3f colour_of(const aiMaterial& source) {
  aiColor4D colour(0.6F, 0.6F, 0.6F, 1.0F);
  if (source.Get(AI_MATKEY_BASE_COLOR, colour) != aiReturn_SUCCESS) {
    source.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  }
  return {share(colour.b), share(colour.g), share(colour.r)};
}

/// The picture's name; empty without one.
aiString texture_name(const aiMaterial& source) {
  aiString name;
  for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
    if (source.GetTexture(type, 0, &name) == aiReturn_SUCCESS && name.length > 0) {
      return name;
    }
  }
  return {};
}

/// The mean colour of a triangle's vertices (red, green, blue), each in `kTones` steps.
std::uint32_t tones_of(const aiMesh& mesh, const aiFace& triangle) {
  aiColor4D sum;
  for (unsigned i = 0; i < triangle.mNumIndices; ++i) {
    sum = sum + mesh.mColors[0][triangle.mIndices[i]];
  }
  std::uint32_t tones = 0;
  for (const float channel : {sum.r, sum.g, sum.b}) {
    const float mean = share(channel / static_cast<float>(triangle.mNumIndices));
    tones = kTones * tones + static_cast<std::uint32_t>(std::lround(mean * (kTones - 1)));
  }
  return tones;
}

Eigen::Vector3f colour_of(std::uint32_t tones) {
  const auto channel = [](std::uint32_t tone) {
    return static_cast<float>(tone % kTones) / static_cast<float>(kTones - 1);
  };
  return {channel(tones), channel(tones / kTones), channel(tones / (kTones * kTones))};
}

}  // namespace

MeshMaterials::MeshMaterials(Scene& scene, const aiScene& source, const std::filesystem::path& file)
    : scene_(scene), source_(source), file_(file) {
  for (unsigned i = 0; i < source.mNumMaterials; ++i) {
    add_material(*source.mMaterials[i]);
  }
  if (materials_.empty()) {
    add_material(aiMaterial());
  }
}

std::uint16_t MeshMaterials::of(const aiMesh& mesh, const aiFace& triangle) {
  const std::size_t own = std::min<std::size_t>(mesh.mMaterialIndex, materials_.size() - 1);
  const bool pictured = scene_.materials[materials_[own]].mapping == TextureMapping::kVertices;
  if (mesh.HasVertexColors(0) && !(pictured && mesh.HasTextureCoords(0))) {
    const auto [found, is_new] = colours_.try_emplace(tones_of(mesh, triangle));
    if (is_new) {
      Material coloured;
      coloured.name = "vertex colour " + std::to_string(colours_.size());
      give_grain(coloured, colour_of(found->first));
      found->second = add(coloured);
    }
    return found->second;
  }
  if (pictured && !mesh.HasTextureCoords(0)) {
    const auto [found, is_new] = grained_.try_emplace(materials_[own]);
    if (is_new) {
      Material grained = scene_.materials[materials_[own]];
      give_grain(grained, grained.colour_bgr);
      found->second = add(grained);
    }
    return found->second;
  }
  return materials_[own];
}

std::uint16_t MeshMaterials::add(Material material) {
  scene_.materials.push_back(std::move(material));
  return static_cast<std::uint16_t>(scene_.materials.size() - 1);
}

void MeshMaterials::give_grain(Material& material, const Eigen::Vector3f& colour_bgr) {
  material.colour_bgr = colour_bgr / kGrainMean;
  material.texture = grain();
  material.mapping = Material().mapping;
  material.texture_edge_m = kGrainEdgeM;
}

void MeshMaterials::add_material(const aiMaterial& source) {
  if (materials_.size() >= 16000) {  // with a grained one each, vertices' colours have the rest
    throw input_error(file_, "holds more than 16000 materials");
  }
  Material material;
  material.name = source.GetName().C_Str();
  const aiString picture = texture_name(source);
  material.colour_bgr = colour_of(source);
  if (picture.length > 0) {
    material.texture = texture(picture);
    material.mapping = TextureMapping::kVertices;
  } else {
    give_grain(material, material.colour_bgr);
  }
  materials_.push_back(add(material));
}

int MeshMaterials::texture(const aiString& name) {
  const auto found = textures_.find(name.C_Str());
  if (found != textures_.end()) {
    return found->second;
  }
  scene_.textures.emplace_back(picture_of(source_, file_, name.C_Str()));
  const int index = static_cast<int>(scene_.textures.size()) - 1;
  textures_.emplace(name.C_Str(), index);
  return index;
}

int MeshMaterials::grain() {
  if (grain_ < 0) {
    scene_.textures.emplace_back(procedural_texture(Pattern::kConcrete, 1));
    grain_ = static_cast<int>(scene_.textures.size()) - 1;
  }
  return grain_;
}

}  // namespace skyhalo
