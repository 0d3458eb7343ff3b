// Files as other programs write them.
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "core/files.h"
#include "tests/scratch.h"
#include "tests/worlds/geometry.h"
#include "tests/worlds/gltf/gltf_text.h"
#include "worlds/gltf/gltf.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;
using Triangle = std::array<uint32_t, 3>;

// A unit square in glTF's x-y plane, z towards the viewer.
const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

const Primitive& only_primitive(const World& world) {
  return world.meshes.at(0).primitives.at(0);
}

template <class T>
std::vector<Triangle> triangles_with_indices(const std::vector<T>& indices, int component_type,
                                             int mode = 4) {
  GltfText text;
  const size_t positions = text.add_accessor(text.add_view(kSquare), 5126, "VEC3", 4);
  const size_t normals =
      text.add_accessor(text.add_view<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}), 5126, "VEC3", 4);
  auto& primitive = text.add_primitive({{"POSITION", positions}, {"NORMAL", normals}});
  primitive["mode"] = mode;
  if (!indices.empty())
    primitive["indices"] =
        text.add_accessor(text.add_view(indices), component_type, "SCALAR", indices.size());
  return only_primitive(read_gltf(text.write("indices.gltf"))).triangles;
}

TEST(GltfRead, TurnsYUpIntoZUp) {
  const World world = read_gltf(GltfText::triangle().write("triangle.gltf"));
  const Primitive& p = only_primitive(world);
  EXPECT_EQ(p.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}));
  EXPECT_EQ(p.normals, (std::vector<Vec3f>(3, Vec3f(0, -1, 0))));  // computed: towards glTF's +z, our -y
  EXPECT_EQ(world.objects.at(0).collision, Collision::mesh);
  EXPECT_EQ(world.materials.at(0).name, "default");
  EXPECT_EQ(world.name, "triangle");
}

TEST(GltfRead, AllIndexTypes) {
  const std::vector<Triangle> expected = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(triangles_with_indices<uint8_t>({0, 1, 2, 0, 2, 3}, 5121), expected);
  EXPECT_EQ(triangles_with_indices<uint16_t>({0, 1, 2, 0, 2, 3}, 5123), expected);
  EXPECT_EQ(triangles_with_indices<uint32_t>({0, 1, 2, 0, 2, 3}, 5125), expected);
  EXPECT_EQ(triangles_with_indices<uint8_t>({}, 0),
            (std::vector<Triangle>{{0, 1, 2}}));  // the rest of 1 is dropped
}

TEST(GltfRead, StripsAndFans) {
  EXPECT_EQ(triangles_with_indices<uint8_t>({0, 1, 3, 2}, 5121, 5),
            (std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}}));
  EXPECT_EQ(triangles_with_indices<uint8_t>({0, 1, 2, 3}, 5121, 6),
            (std::vector<Triangle>{{1, 2, 0}, {2, 3, 0}}));
}

TEST(GltfRead, LinesAndPointsAreLeftOut) {
  GltfText text = GltfText::triangle();
  auto& primitives = text.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives.push_back(primitives[0]);
  primitives[0]["mode"] = 0;
  primitives[1]["mode"] = 3;
  EXPECT_EQ(read_gltf(text.write("lines.gltf")).meshes[0].primitives.size(), 1u);
}

TEST(GltfRead, InterleavedAttributes) {
  GltfText text;
  struct Interleaved {
    float position[3], normal[3], uv[2];
  };
  std::vector<Interleaved> vertices(3);
  for (size_t i = 0; i < 3; ++i) {
    const auto f = static_cast<float>(i);
    vertices[i] = {{f, f * f, 0.5f * f}, {0, 0, 1}, {0.25f * f, 1 - f}};
  }
  const size_t view = text.add_view(vertices, sizeof(Interleaved));
  text.add_primitive({{"POSITION", text.add_accessor(view, 5126, "VEC3", 3, 0)},
                      {"NORMAL", text.add_accessor(view, 5126, "VEC3", 3, 12)},
                      {"TEXCOORD_0", text.add_accessor(view, 5126, "VEC2", 3, 24)}});
  const Primitive p = only_primitive(read_gltf(text.write("interleaved.gltf")));
  EXPECT_EQ(p.positions[2], Vec3f(2, -1, 4));
  EXPECT_EQ(p.normals[2], Vec3f(0, -1, 0));
  EXPECT_EQ(p.uvs[2], Vec2f(0.5f, -1));
}

TEST(GltfRead, SparseAccessorsReplaceElements) {
  GltfText text = GltfText::triangle();
  const size_t places = text.add_view<uint8_t>({2}), values = text.add_view<float>({5, 6, 7});
  text.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  EXPECT_EQ(only_primitive(read_gltf(text.write("sparse.gltf"))).positions[2], Vec3f(5, -7, 6));
  text.json["accessors"][0].erase("bufferView");  // then all others are zero
  text.json["accessors"][0]["sparse"]["count"] = 1;
  const Primitive p = only_primitive(read_gltf(text.write("zeros.gltf")));
  EXPECT_EQ(p.positions, (std::vector<Vec3f>{{0, 0, 0}, {0, 0, 0}, {5, -7, 6}}));
}

TEST(GltfRead, NormalisedAndPlainIntegers) {
  GltfText text;
  const size_t positions = text.add_accessor(
      text.add_view<int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, -32768, -32767, 0, 0}, 8), 5122, "VEC3", 3);
  text.json["accessors"][positions]["normalized"] = true;
  const size_t uvs = text.add_accessor(text.add_view<uint8_t>({0, 255, 0, 0, 51, 102, 0, 0, 255, 0, 0, 0}, 4),
                                       5121, "VEC2", 3);
  text.json["accessors"][uvs]["normalized"] = true;
  text.json["extensionsUsed"] = text.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  text.add_primitive({{"POSITION", positions}, {"TEXCOORD_0", uvs}});
  const Primitive p = only_primitive(read_gltf(text.write("quantized.gltf")));
  EXPECT_EQ(p.positions[1], Vec3f(1, 0, 0));
  EXPECT_EQ(p.positions[2], Vec3f(-1, 0, -1));
  EXPECT_EQ(p.uvs[1], Vec2f(51 / 255.0f, 102 / 255.0f));
  text.json["accessors"][positions].erase("normalized");
  EXPECT_EQ(only_primitive(read_gltf(text.write("quantized.gltf"))).positions[1], Vec3f(32767, 0, 0));
}

TEST(GltfRead, HierarchyOfMatricesAndTrs) {
  GltfText text = GltfText::triangle();
  const double s = std::sqrt(0.5);
  text.json["nodes"] = {
      {{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, s, 0, s}}},
      {{"mesh", 0}, {"name", "child"}, {"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, -3, 1}}},
      {{"mesh", 0}, {"scale", {1, 2, 3}}}};
  text.json["scenes"][0]["nodes"] = {0, 2};
  const World world = read_gltf(text.write("tree.gltf"));
  ASSERT_EQ(world.objects.size(), 2u);
  EXPECT_EQ(world.objects[0].name, "child");
  EXPECT_EQ(world.objects[0].mesh, world.objects[1].mesh);  // instances share their mesh
  // glTF: a quarter turn about y takes x to -z and -z to -x, so (1 0 0) goes to 2 x, then (2 0 -3) to (-3 0 -2) + 10.
  const Vec3 corner = world.objects[0].T_world_object * only_primitive(world).positions[1].cast<double>();
  EXPECT_LT((corner - Vec3(7, 2, 0)).norm(), 1e-12);
  EXPECT_LT((world.objects[1].T_world_object * Vec3(1, 1, 1) - Vec3(1, 3, 2)).norm(), 1e-12);
}

TEST(GltfRead, MirroringKeepsFrontFacesInFront) {
  GltfText text = GltfText::triangle();
  text.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"scale", {-1, 1, 1}}}};
  text.json["scenes"][0]["nodes"] = {0, 1};
  const auto triangles = triangles_of(read_gltf(text.write("mirror.gltf")));
  ASSERT_EQ(triangles.size(), 2u);
  EXPECT_LT((triangles[0].normal() - Vec3(0, -1, 0)).norm(), 1e-12);
  EXPECT_LT((triangles[1].normal() - Vec3(0, -1, 0)).norm(), 1e-12);
  EXPECT_EQ(triangles[1].corners_world[2].x() + triangles[1].corners_world[1].x(), -1);
}

TEST(GltfRead, WithoutScenesAllRootsCount) {
  GltfText text = GltfText::triangle();
  text.json.erase("scene");
  text.json.erase("scenes");
  text.json["nodes"] = {{{"children", {1}}}, {{"mesh", 0}}, {{"mesh", 0}}};
  EXPECT_EQ(read_gltf(text.write("no_scene.gltf")).objects.size(), 2u);
}

TEST(GltfRead, LightsStandAndPointWhereTheirNodeSays) {
  GltfText text = GltfText::triangle();
  const double s = std::sqrt(0.5);
  text.json["extensionsUsed"] = {"KHR_lights_punctual"};
  text.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"},
                                                               {"color", {1, 0.5, 0}},
                                                               {"intensity", 30},
                                                               {"range", 9},
                                                               {"spot", {{"outerConeAngle", 0.5}}}},
                                                              {{"type", "directional"}}};
  text.json["nodes"].push_back({{"translation", {1, 2, 3}},
                                {"rotation", {-s, 0, 0, s}},  // -z down to -y
                                {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  text.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  text.json["scenes"][0]["nodes"] = {0, 1, 2};
  const World world = read_gltf(text.write("lights.gltf"));
  ASSERT_EQ(world.lights.size(), 2u);
  const Light& spot = world.lights[0];
  EXPECT_EQ(spot.kind, Light::Kind::spot);
  EXPECT_EQ(spot.position_world, Vec3(1, -3, 2));
  EXPECT_LT((spot.direction_world - Vec3(0, 0, -1)).norm(), 1e-12);
  EXPECT_EQ(spot.color, Vec3f(1, 0.5f, 0));
  EXPECT_EQ(spot.range_m, 9);
  EXPECT_EQ(spot.outer_cone_rad, 0.5);
  EXPECT_EQ(world.lights[1].kind, Light::Kind::directional);
  EXPECT_EQ(world.lights[1].direction_world, Vec3(0, 1, 0));
}

// Small images as data URIs: red and green side by side; 16 bits, 0x4080; 8 x 8 pixels of grey 200.
const std::string kPng =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR4nGP4z8DA8J8BAAf/"
    "Af8Bf4mnAAAAAElFTkSuQmCC";
const std::string kPng16 =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABEAAAAABq7kcWAAAAC0lEQVR4nGNwaAAAAQMAwdQh4PoAAAAASUVORK5CYII=";
const std::string kJpeg =
    "data:image/jpeg;base64,"
    "/9j/4AAQSkZJRgABAQAAAQABAAD/2wCEAFA3PEY8MlBGQUZaVVBfeMiCeG5uePWvuZHI////////////////////////////"
    "//////////////////////8BVVpaeGl464KC6///////////////////////////////////////////////////////////"
    "///////////////AABEIAAgACAMBIgACEQEDEQH/xAGiAAABBQEBAQEBAQAAAAAAAAAAAQIDBAUGBwgJCgsQAAIBAwMCBAMF"
    "BQQEAAABfQECAwAEEQUSITFBBhNRYQcicRQygZGhCCNCscEVUtHwJDNicoIJChYXGBkaJSYnKCkqNDU2Nzg5OkNERUZHSElK"
    "U1RVVldYWVpjZGVmZ2hpanN0dXZ3eHl6g4SFhoeIiYqSk5SVlpeYmZqio6Slpqeoqaqys7S1tre4ubrCw8TFxsfIycrS09TV"
    "1tfY2drh4uPk5ebn6Onq8fLz9PX29/j5+gEAAwEBAQEBAQEBAQAAAAAAAAECAwQFBgcICQoLEQACAQIEBAMEBwUEBAABAncA"
    "AQIDEQQFITEGEkFRB2FxEyIygQgUQpGhscEJIzNS8BVictEKFiQ04SXxFxgZGiYnKCkqNTY3ODk6Q0RFRkdISUpTVFVWV1hZ"
    "WmNkZWZnaGlqc3R1dnd4eXqCg4SFhoeIiYqSk5SVlpeYmZqio6Slpqeoqaqys7S1tre4ubrCw8TFxsfIycrS09TV1tfY2dri"
    "4+Tl5ufo6ery8/T19vf4+fr/2gAMAwEAAhEDEQA/AJ6KKKAP/9k=";

GltfText textured(const std::string& uri) {
  GltfText text = GltfText::triangle();
  const size_t uvs = text.add_accessor(text.add_view<float>({0, 0, 1, 0, 0, 1}), 5126, "VEC2", 3);
  auto& primitive = text.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_0"] = uvs;
  primitive["material"] = 0;
  text.json["images"] = {{{"uri", uri}}};
  text.json["textures"] = {{{"source", 0}}};
  text.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  return text;
}

TEST(GltfRead, ImagesFromDataUris) {
  const World world = read_gltf(textured(kPng).write("png.gltf"));
  ASSERT_EQ(world.textures.size(), 1u);
  EXPECT_EQ(world.textures[0].width_px, 2);
  EXPECT_EQ(world.textures[0].rgba, (std::vector<uint8_t>{255, 0, 0, 255, 0, 255, 0, 255}));
  EXPECT_EQ(world.materials[0].base_color_texture, 0);
  EXPECT_NEAR(world.materials[0].lidar_albedo, (0.2126 + 0.7152) / 2, 1e-4);
  const World deep = read_gltf(textured(kPng16).write("png16.gltf"));
  EXPECT_EQ(deep.textures[0].rgba, (std::vector<uint8_t>{0x40, 0x40, 0x40, 255}));
  const World jpeg = read_gltf(textured(kJpeg).write("jpeg.gltf"));
  ASSERT_EQ(jpeg.textures[0].rgba.size(), 4u * 64);
  EXPECT_NEAR(jpeg.textures[0].rgba[0], 200, 6);
}

TEST(GltfRead, TextureTransformChoosesItsOwnCoordinates) {
  GltfText text = textured(kPng);
  const size_t other = text.add_accessor(text.add_view<float>({7, 7, 8, 8, 9, 9}), 5126, "VEC2", 3);
  text.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = other;
  text.json["extensionsUsed"] = {"KHR_texture_transform"};
  text.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]
           ["KHR_texture_transform"] = {
      {"offset", {0.5, 0.25}}, {"scale", {2, 3}}, {"rotation", 0.125}, {"texCoord", 1}};
  const World world = read_gltf(text.write("transform.gltf"));
  EXPECT_EQ(world.materials[0].base_color_transform.offset, Vec2f(0.5f, 0.25f));
  EXPECT_EQ(world.materials[0].base_color_transform.scale, Vec2f(2, 3));
  EXPECT_EQ(world.materials[0].base_color_transform.rotation_rad, 0.125f);
  EXPECT_EQ(only_primitive(world).uvs[2], Vec2f(9, 9));
}

TEST(GltfRead, BuffersAndImagesBesideTheFile) {
  GltfText text = textured("picture%20one.png");
  const fs::path folder = scratch_folder() / "beside";
  fs::create_directories(folder);
  const std::string bytes(text.bytes.begin(), text.bytes.end());
  write_file(folder / "data one.bin", bytes + "and more than the buffer needs");
  const std::string png_text = kPng.substr(kPng.find(',') + 1);
  std::string png;
  for (size_t i = 0, word = 0, bits = 0; i < png_text.size() && png_text[i] != '='; ++i) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    word = word << 6 | digits.find(png_text[i]);
    bits += 6;
    if (bits >= 8) png += static_cast<char>(word >> (bits -= 8) & 255);
  }
  write_file(folder / "picture one.png", png);
  text.json["buffers"] = {{{"byteLength", text.bytes.size()}, {"uri", "data%20one.bin"}}};
  write_file(folder / "scene.gltf", text.dump());
  const World world = read_gltf(folder / "scene.gltf");
  EXPECT_EQ(only_primitive(world).positions[1], Vec3f(1, 0, 0));
  EXPECT_EQ(world.textures[0].width_px, 2);
}

TEST(GltfRead, MaterialsGetSensibleLidarValues) {
  GltfText text = GltfText::triangle();
  text.json["meshes"][0]["primitives"][0]["material"] = 0;
  text.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}}}},
      {{"alphaMode", "BLEND"}},
      {{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}}}}},
      {{"extras", {{"vsslam", {{"lidar_albedo", 0.07}, {"retro_reflective", true}}}}}},
      {{"emissiveFactor", {0.5, 0, 0}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}}};
  const World world = read_gltf(text.write("materials.gltf"));
  EXPECT_NEAR(world.materials[0].lidar_albedo, 0.5, 1e-6);
  EXPECT_FALSE(world.materials[0].glass);
  EXPECT_TRUE(world.materials[1].glass);
  EXPECT_TRUE(world.materials[2].glass);
  EXPECT_EQ(world.materials[3].lidar_albedo, 0.07f);
  EXPECT_TRUE(world.materials[3].retro_reflective);
  EXPECT_EQ(world.materials[4].emissive, Vec3f(4, 0, 0));
  EXPECT_EQ(world.materials[4].roughness, 1);
}

TEST(GltfRead, ManyPrimitivesMayShareOneVertexArray) {
  GltfText text;
  const size_t positions = text.add_accessor(text.add_view(kSquare), 5126, "VEC3", 4);
  auto& primitive = text.add_primitive({{"POSITION", positions}});
  primitive["indices"] = text.add_accessor(text.add_view<uint8_t>({0, 2, 3}), 5121, "SCALAR", 3);
  const Primitive p = only_primitive(read_gltf(text.write("shared.gltf")));
  EXPECT_EQ(p.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 1}, {0, 0, 1}}));
}

}  // namespace
}  // namespace vsslam
