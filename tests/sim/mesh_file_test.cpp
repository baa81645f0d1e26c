#include "skyhalo/sim/mesh_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3f;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

const std::string kTriangle = "v 1 2 3\nv 4 2 3\nv 1 2 9\nf 1 2 3\n";

Scene read(const std::string& name, const std::string& bytes, const MeshFileOptions& options = {}) {
  const TempFolder folder;
  return read_scene(folder.write(name, bytes), options);
}

std::string complaint(const std::string& name, const std::string& bytes) {
  return message_of([&] { (void)read(name, bytes); });
}

/// The mesh's corners in the triangles' order.
std::vector<Vector3f> corners(const TriangleMesh& mesh) {
  std::vector<Vector3f> result;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      result.push_back(mesh.vertices_m[vertex]);
    }
  }
  return result;
}

const Material& material_of(const Scene& scene, std::size_t triangle) {
  return scene.materials[scene.fixed.materials[triangle]];
}

/// A PNG of one colour.
std::string png(const cv::Vec3b& colour) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", cv::Mat3b(4, 4, colour), bytes);
  return {bytes.begin(), bytes.end()};
}

void append_float(std::string& bytes, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (unsigned shift = 0; shift < 32; shift += 8) {
    bytes += static_cast<char>((bits >> shift) & 0xFFU);
  }
}

/// A glTF file of one triangle in a node that is moved by (10, 0, 0), and its binary file.
std::filesystem::path write_gltf(const TempFolder& folder, float first_x) {
  std::string bytes;
  for (const float value : {first_x, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F}) {
    append_float(bytes, value);
  }
  folder.write("one.bin", bytes);
  return folder.write("one.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"mesh":0,"translation":[10,0,0]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
    "materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1.0,0.5,0.0,1.0]}}],
    "buffers":[{"uri":"one.bin","byteLength":36}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
                  "min":[0,0,0],"max":[1,1,0]}]})");
}

TEST(MeshFileTest, AnObjKeepsItsPlaces) {
  const Scene scene = read("one.obj", kTriangle);
  EXPECT_EQ(scene.name, "one");
  EXPECT_THAT(
      corners(scene.fixed),
      ::testing::ElementsAre(
          Vector3f(1.0F, 2.0F, 3.0F), Vector3f(4.0F, 2.0F, 3.0F), Vector3f(1.0F, 2.0F, 9.0F)));
  EXPECT_NO_THROW(check(scene));
  EXPECT_TRUE(scene.movers.empty());
  EXPECT_TRUE(scene.route_m.empty());
}

TEST(MeshFileTest, UnitsAndUpAxesAreApplied) {
  // The first corner is 1 along the file's x, 2 along its y and 3 along its z.
  EXPECT_EQ(corners(read("one.obj", kTriangle, {.unit_m = 0.5}).fixed)[0],
            Vector3f(0.5F, 1.0F, 1.5F));
  EXPECT_EQ(corners(read("one.obj", kTriangle, {.up = UpAxis::kY}).fixed)[0],
            Vector3f(-3.0F, -1.0F, 2.0F));
  EXPECT_EQ(corners(read("one.obj", kTriangle, {.up = UpAxis::kX}).fixed)[0],
            Vector3f(-3.0F, 2.0F, 1.0F));
  EXPECT_EQ(corners(read("one.obj", kTriangle, {.unit_m = 2.0, .up = UpAxis::kY}).fixed)[0],
            Vector3f(-6.0F, -2.0F, 4.0F));
}

TEST(MeshFileTest, APolygonIsCutIntoTriangles) {
  const Scene scene = read("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  EXPECT_EQ(scene.fixed.triangles.size(), 2U);
}

TEST(MeshFileTest, MaterialsAndPicturesComeFromBesideTheFile) {
  const TempFolder folder;
  folder.write("two.mtl",
               "newmtl red\nKd 1 0 0\nnewmtl pictured\nKd 1 1 1\nmap_Kd pictures/blue.png\n");
  folder.write("pictures/blue.png", png({255, 0, 0}));
  const Scene scene = read_scene(
      folder.write("two.obj",
                   "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 0.75\n"
                   "usemtl red\nf 1 2 3\nusemtl pictured\nf 1/1 2/2 3/3\n"),
      {});
  ASSERT_EQ(scene.fixed.triangles.size(), 2U);
  const Material& red = material_of(scene, 0);
  EXPECT_EQ(red.name, "red");
  EXPECT_EQ(red.colour_bgr.head<2>(), Eigen::Vector2f::Zero());
  EXPECT_GT(red.colour_bgr.z(), 0.9F);
  EXPECT_EQ(red.mapping, TextureMapping::kPosition);
  EXPECT_GE(red.texture, 0);  // a grain, for the eyes of stereo cameras
  const Material& pictured = material_of(scene, 1);
  EXPECT_EQ(pictured.mapping, TextureMapping::kVertices);
  const Texture& picture = scene.textures[static_cast<std::size_t>(pictured.texture)];
  EXPECT_EQ(picture.at(0.5F, 0.5F, 0.0F), Vector3f(1.0F, 0.0F, 0.0F));
  // The file's v points up, a texture's down.
  EXPECT_EQ(scene.fixed.uvs[scene.fixed.triangles[1][2]], Eigen::Vector2f(0.0F, 0.25F));
}

TEST(MeshFileTest, AGltfFileComesWithItsNodesAndColours) {
  const TempFolder folder;
  const Scene scene = read_scene(write_gltf(folder, 0.0F), {.up = UpAxis::kY});
  EXPECT_THAT(corners(scene.fixed),
              ::testing::ElementsAre(Vector3f(0.0F, -10.0F, 0.0F),
                                     Vector3f(0.0F, -11.0F, 0.0F),
                                     Vector3f(0.0F, -10.0F, 1.0F)));
  const Vector3f colour = material_of(scene, 0).colour_bgr;
  EXPECT_EQ(colour.x(), 0.0F);
  EXPECT_NEAR(colour.y() / colour.z(), 0.5F, 1e-5F);
}

TEST(MeshFileTest, APlyKeepsTheColoursOfItsVertices) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  const Scene scene = read("two.ply",
                           head +
                               "0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n"
                               "0 0 1 0 0 255\n1 0 1 0 0 255\n0 1 1 0 0 255\n3 0 1 2\n3 3 4 5\n");
  ASSERT_EQ(scene.fixed.triangles.size(), 2U);
  const Vector3f first = material_of(scene, 0).colour_bgr;
  const Vector3f second = material_of(scene, 1).colour_bgr;
  EXPECT_EQ(first.x(), 0.0F);
  EXPECT_GT(first.z(), 0.9F);
  EXPECT_GT(second.x(), 0.9F);
  EXPECT_EQ(second.z(), 0.0F);
}

/// One picture for two materials; the first mesh has places in it, the second none.
TEST(MeshFileTest, APictureIsKeptOnceAndNeedsPlacesInIt) {
  const TempFolder folder;
  folder.write("two.mtl", "newmtl a\nmap_Kd blue.png\nnewmtl b\nmap_Kd blue.png\n");
  folder.write("blue.png", png({255, 0, 0}));
  const Scene scene = read_scene(folder.write("two.obj",
                                              "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                                              "usemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 1 2 3\n"),
                                 {});
  ASSERT_EQ(scene.fixed.triangles.size(), 2U);
  EXPECT_EQ(scene.textures.size(), 2U);  // the picture and the grain
  EXPECT_EQ(material_of(scene, 0).mapping, TextureMapping::kVertices);
  EXPECT_EQ(material_of(scene, 1).mapping, TextureMapping::kPosition);
  EXPECT_NE(material_of(scene, 0).texture, material_of(scene, 1).texture);
}

TEST(MeshFileTest, AFaceOfNoVertexIsAnError) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\n";
  const std::string colour = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  EXPECT_THAT(complaint("coloured.ply",
                        head + colour + faces +
                            "0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0 9 9 9\n1 1 0 9 9 9\n3 0 1 900000\n"),
              HasSubstr("vertex 900000, but the mesh has 4"));
  EXPECT_THAT(complaint("quad.ply", head + faces + "0 0 0\n1 0 0\n0 1 0\n1 1 0\n4 0 1 2 900000\n"),
              HasSubstr("quad.ply: face 0"));
  EXPECT_THAT(complaint("minus.ply", head + faces + "0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 -1\n"),
              HasSubstr("minus.ply: "));
}

TEST(MeshFileTest, AFileThatIsNoneIsNamed) {
  const TempFolder folder;
  const std::filesystem::path missing = folder.path() / "none.obj";
  EXPECT_EQ(message_of([&] { (void)read_scene(missing, {}); }),
            missing.string() + ": there is no such file");
  EXPECT_EQ(message_of([&] { (void)read_scene(folder.path(), {}); }),
            folder.path().string() + ": is no file; expected a mesh");
}

TEST(MeshFileTest, WhatIsNoMeshIsNamed) {
  for (const std::string name : {"a.txt", "a.ply", "a.glb", "a.gltf", "a.unheard"}) {
    EXPECT_THAT(complaint(name, "this is no mesh"), HasSubstr(name + ": cannot be read as a mesh:"))
        << name;
  }
  EXPECT_THAT(complaint("empty.ply", ""), HasSubstr("empty.ply: "));
  EXPECT_THAT(complaint("empty.obj", ""), HasSubstr("empty.obj: "));
  EXPECT_THAT(complaint("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), HasSubstr("points.obj: "));
  EXPECT_THAT(complaint("line.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"),
              HasSubstr("line.obj: holds no triangle"));
  EXPECT_THAT(complaint("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n"),
              HasSubstr("index.obj: "));
}

TEST(MeshFileTest, ACoordinateThatIsNotFiniteIsAnError) {
  for (const std::string wrong : {"nan", "inf", "-inf", "1e300"}) {
    EXPECT_THAT(complaint("bad.obj", "v 1 2 3\nv 4 " + wrong + " 3\nv 1 2 9\nf 1 2 3\n"),
                HasSubstr("bad.obj: vertex "))
        << wrong;
  }
  const TempFolder folder;
  const auto file = write_gltf(folder, std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(message_of([&] { (void)read_scene(file, {}); }),
              HasSubstr("a coordinate is not finite"));
  EXPECT_THAT(complaint("far.obj", "v 1e8 2 3\nv 4 2 3\nv 1 2 9\nf 1 2 3\n"),
              HasSubstr("beyond 100 km"));
}

TEST(MeshFileTest, APictureThatCannotBeReadIsNamed) {
  const auto with_picture = [](const std::string& name) {
    const TempFolder folder;
    folder.write("one.mtl", "newmtl a\nmap_Kd " + name + "\n");
    folder.write("broken.png", "no picture");
    const auto file = folder.write("one.obj", "mtllib one.mtl\nusemtl a\n" + kTriangle);
    return message_of([&] { (void)read_scene(file, {}); });
  };
  EXPECT_THAT(with_picture("missing.png"),
              HasSubstr("one.obj: texture \"missing.png\" cannot be read as a picture"));
  EXPECT_THAT(with_picture("broken.png"), HasSubstr("texture \"broken.png\" cannot be read"));
  for (const std::string outside :
       {"../secret.png", "/etc/secret.png", "a/../../secret.png", "..\\secret.png"}) {
    EXPECT_THAT(with_picture(outside), HasSubstr("lies outside of the file's folder")) << outside;
  }
}

TEST(MeshFileTest, AUnitThatIsNoneIsRefused) {
  for (const double unit_m : {0.0,
                              -1.0,
                              std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity()}) {
    const std::string message =
        message_of([&] { (void)read("one.obj", kTriangle, {.unit_m = unit_m}); });
    EXPECT_THAT(message, HasSubstr("the unit must be greater than 0 m"));
  }
}

}  // namespace
}  // namespace skyhalo
