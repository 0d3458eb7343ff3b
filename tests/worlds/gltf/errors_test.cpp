// Broken files: a clear InputError each, never a crash.
#include "core/errors.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "core/files.h"
#include "core/rng.h"
#include "tests/scratch.h"
#include "tests/worlds/gltf/gltf_text.h"
#include "worlds/gltf/gltf.h"
#include "worlds/indoor/room.h"

namespace vsslam {
namespace {

using nlohmann::json;

std::string error_of(const std::string& bytes, const std::string& name = "broken.gltf") {
  const std::filesystem::path path = scratch_folder() / name;
  write_file(path, bytes);
  try {
    read_gltf(path);
  } catch (const InputError& e) {
    const std::string text = e.what(), prefix = path.string() + ": ";
    EXPECT_TRUE(text.starts_with(prefix)) << text;
    return text.substr(std::min(prefix.size(), text.size()));
  }
  return "";
}

GltfText indexed_triangle() {
  GltfText text = GltfText::triangle();
  text.json["meshes"][0]["primitives"][0]["indices"] =
      text.add_accessor(text.add_view<uint16_t>({0, 1, 2}), 5123, "SCALAR", 3);
  return text;
}

std::string after(const std::function<void(GltfText&)>& damage) {
  GltfText text = indexed_triangle();
  damage(text);
  return error_of(text.dump());
}

TEST(GltfErrors, TheUndamagedFileLoads) {
  EXPECT_EQ(error_of(indexed_triangle().dump()), "");
}

TEST(GltfErrors, IndicesOutOfRange) {
  EXPECT_EQ(after([](GltfText& t) { t.bytes[t.bytes.size() - 2] = 77; }),
            "accessors[1]: index 77 out of range (3 vertices)");
  EXPECT_EQ(after([](GltfText& t) { t.json["nodes"][0]["mesh"] = 5; }),
            "nodes[0].mesh: index 5 out of range (1 meshes)");
  EXPECT_EQ(after([](GltfText& t) { t.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 9; }),
            "meshes[0].primitives[0].attributes.POSITION: index 9 out of range (2 accessors)");
  EXPECT_EQ(after([](GltfText& t) {
              t.json["scenes"][0]["nodes"] = {0, 3};
            }),
            "scenes[0].nodes[1]: index 3 out of range (1 nodes)");
  EXPECT_EQ(after([](GltfText& t) { t.json["meshes"][0]["primitives"][0]["material"] = 0; }),
            "meshes[0].primitives[0].material: points into materials, which is missing");
}

TEST(GltfErrors, BuffersTooShort) {
  EXPECT_EQ(after([](GltfText& t) { t.json["bufferViews"][0]["byteLength"] = 1000; }),
            "bufferViews[0]: ends at byte 1000, past the end of buffers[0] (42 bytes)");
  EXPECT_EQ(after([](GltfText& t) { t.json["accessors"][0]["count"] = 4; }),
            "accessors[0]: 4 elements do not fit into bufferViews[0] (36 bytes)");
  EXPECT_EQ(after([](GltfText& t) { t.json["accessors"][0]["byteOffset"] = 4; }),
            "accessors[0]: 3 elements do not fit into bufferViews[0] (36 bytes)");
  EXPECT_EQ(after([](GltfText& t) { t.json["bufferViews"][0]["byteStride"] = 8; }),
            "accessors[0]: byteStride 8 is less than an element's 12 bytes");
  EXPECT_NE(after([](GltfText& t) {
              t.json["buffers"] = {
                  {{"byteLength", 50}, {"uri", "data:application/octet-stream;base64," + base64(t.bytes)}}};
            }),
            "");
}

TEST(GltfErrors, AbsurdCounts) {
  EXPECT_EQ(after([](GltfText& t) { t.json["accessors"][0]["count"] = 4e9; }),
            "accessors[0].count: expected a whole number from 0 to 2^31 - 1");
  EXPECT_NE(after([](GltfText& t) { t.json["accessors"][0]["count"] = 2147483647; }), "");
  EXPECT_NE(after([](GltfText& t) {
              t.json["accessors"][0]["count"] = 2000000000;
              t.json["accessors"][0].erase("bufferView");
            }),
            "");
  EXPECT_NE(after([](GltfText& t) {
              t.json["buffers"] = {
                  {{"byteLength", 2147483647}, {"uri", "data:application/octet-stream;base64,AAAA"}}};
            }),
            "");
  EXPECT_EQ(after([](GltfText& t) { t.json["bufferViews"][0]["byteOffset"] = -4; }),
            "bufferViews[0].byteOffset: expected a whole number from 0 to 2^31 - 1");
}

TEST(GltfErrors, NumbersThatAreNone) {
  const auto with_float = [](float value) {
    return after([&](GltfText& t) { std::memcpy(&t.bytes[12], &value, sizeof value); });
  };
  EXPECT_EQ(with_float(std::numeric_limits<float>::quiet_NaN()),
            "meshes[0].primitives[0].attributes.POSITION: accessors[0]: element 1 is not finite");
  EXPECT_NE(with_float(std::numeric_limits<float>::infinity()), "");
  EXPECT_NE(with_float(1e30f), "");  // farther than the coordinates of a world can tell apart
  EXPECT_NE(after([](GltfText& t) { t.json["nodes"][0]["translation"] = {1e300, 0, 0}; }), "");
  EXPECT_EQ(after([](GltfText& t) {
              t.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
            }),
            "nodes[0]: its rotation is zero");
  EXPECT_NE(after([](GltfText& t) {
              t.json["nodes"][0]["matrix"] = json::array({1, 0, 0, 7, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
            }),
            "");
}

TEST(GltfErrors, NodesThatAreNoTree) {
  EXPECT_EQ(after([](GltfText& t) {
              t.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
            }),
            "nodes[0]: is its own ancestor");
  EXPECT_EQ(after([](GltfText& t) {
              t.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
              t.json["scenes"][0]["nodes"] = {0, 1};
            }),
            "nodes[2]: has two parents, nodes[0] and nodes[1]");
  EXPECT_NE(after([](GltfText& t) { t.json["nodes"][0]["children"] = {0}; }), "");
}

TEST(GltfErrors, ADeepChainOfNodesIsNoProblem) {
  GltfText text = GltfText::triangle();
  constexpr int kDepth = 20000;
  text.json["nodes"] = json::array();
  for (int i = 0; i + 1 < kDepth; ++i) text.json["nodes"].push_back({{"children", {i + 1}}});
  text.json["nodes"].push_back({{"mesh", 0}});
  EXPECT_EQ(error_of(text.dump()), "");
}

TEST(GltfErrors, WrongTypesAndMissingMembers) {
  EXPECT_EQ(after([](GltfText& t) { t.json["nodes"][0]["mesh"] = "first"; }),
            "nodes[0].mesh: expected an index into meshes");
  EXPECT_EQ(after([](GltfText& t) { t.json["nodes"] = 3; }), "nodes: expected a list");
  EXPECT_EQ(after([](GltfText& t) { t.json["accessors"][0].erase("type"); }),
            "accessors[0].type: is missing");
  EXPECT_EQ(after([](GltfText& t) { t.json["accessors"][0]["type"] = "VEC2"; }),
            "accessors[0].type: \"VEC2\" is not what meshes[0].primitives[0].attributes.POSITION needs");
  EXPECT_EQ(after([](GltfText& t) { t.json["accessors"][0]["componentType"] = 5124; }),
            "accessors[0].componentType: unknown type 5124");
  EXPECT_EQ(after([](GltfText& t) { t.json["asset"]["version"] = "1.0"; }),
            "asset.version: expected 2.x, got \"1.0\"");
  EXPECT_EQ(after([](GltfText& t) { t.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }),
            "extensionsRequired[0]: \"KHR_draco_mesh_compression\" is not supported");
  EXPECT_EQ(after([](GltfText& t) { t.json["nodes"][0]["extras"]["vsslam"]["collision"] = "soft"; }),
            "nodes[0].extras.vsslam.collision: expected \"mesh\" or \"none\"");
  EXPECT_EQ(after([](GltfText& t) {
              t.json["scenes"][0]["extras"]["vsslam"]["routes"] = {{{"name", "r"}, {"points_world", {1}}}};
            }),
            "scenes[0].extras.vsslam.routes: r: expected points of three numbers");
}

TEST(GltfErrors, MissingAndEmptyFiles) {
  EXPECT_NE(after([](GltfText& t) {
              t.json["buffers"] = {{{"byteLength", 42}, {"uri", "nowhere.bin"}}};
            }).find("nowhere.bin"),
            std::string::npos);
  EXPECT_NE(after([](GltfText& t) { t.json["buffers"] = {{{"byteLength", 42}}}; }), "");
  EXPECT_EQ(after([](GltfText& t) { t.json["scenes"][0]["nodes"] = json::array(); }), "no triangles");
  EXPECT_EQ(error_of(R"({"asset": {"version": "2.0"}})"), "no triangles");
  EXPECT_NE(error_of(""), "");
  EXPECT_NE(error_of("glTF", "short.glb"), "");
  EXPECT_NE(error_of("[1, 2]"), "");
  EXPECT_NE(error_of("{\"a\": " + std::string(100000, '[')), "");
  EXPECT_THROW(read_gltf("/nowhere/at/all.glb"), InputError);
}

TEST(GltfErrors, Images) {
  const auto with_image = [](const json& image) {
    return after([&](GltfText& t) {
      t.json["images"] = {image};
      t.json["textures"] = {{{"source", 0}}};
      t.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    });
  };
  EXPECT_EQ(with_image({{"uri", "data:image/png;base64,AAAAAAAA"}}), "images[0]: neither PNG nor JPEG");
  EXPECT_EQ(with_image({{"uri", "nowhere.png"}}), "images[0]: cannot read \"nowhere.png\"");
  EXPECT_EQ(with_image({{"name", "nothing"}}), "images[0]: expected either uri or bufferView");
  const auto header = [](uint8_t size) {  // a PNG's first bytes, with this size in the second highest byte
    const std::vector<uint8_t> bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n', 0, 0, 0,
                                        13,   'I', 'H', 'D', 'R',  0,    size, 0,    0, 0, size,
                                        0,    0,   8,   6,   0,    0,    0,    0,    0, 0};
    return json{{"uri", "data:image/png;base64," + base64(bytes)}};
  };
  EXPECT_EQ(with_image(header(0)), "images[0]: has no pixels");
  EXPECT_EQ(with_image(header(2)), "images[0]: 131072 x 131072 pixels are too many");
}

TEST(GltfErrors, TruncatedBinaries) {
  RoomConfig config;
  config.textures = false;
  const std::filesystem::path path = scratch_folder() / "whole.glb";
  write_glb(make_room(config), path);
  const std::string whole = read_file(path);
  for (size_t i = 0; i < 60; ++i)
    EXPECT_NE(error_of(whole.substr(0, whole.size() * i / 60), "truncated.glb"), "") << i;
}

// Seeded damage to a valid file. Anything may come of it but a crash, a hang or another exception.
void fuzz(const std::string& valid, const std::string& name, int rounds) {
  const RandomStream stream(17, name);
  const std::string alphabet = "0123456789-+.eE\"[]{},:nNtf\\ ";
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    std::string damaged = valid;
    const auto draw = [&](uint64_t k, size_t size) {
      return static_cast<size_t>(stream.uniform(static_cast<uint64_t>(round), k) * static_cast<double>(size));
    };
    const size_t count = 1 + draw(0, 6);
    for (uint64_t k = 1; k <= count; ++k) {
      const size_t at = draw(10 * k, damaged.size());
      switch (draw(10 * k + 1, 4)) {
        case 0:
          damaged[at] = static_cast<char>(draw(10 * k + 2, 256));
          break;
        case 1:
          damaged[at] = alphabet[draw(10 * k + 3, alphabet.size())];
          break;
        case 2:
          damaged.erase(at, 1 + draw(10 * k + 4, 8));
          break;
        default:
          damaged.insert(at, 1, alphabet[draw(10 * k + 5, alphabet.size())]);
      }
      if (damaged.empty()) damaged = "x";
    }
    refused += !error_of(damaged, name).empty();
  }
  EXPECT_GT(refused, rounds / 4);
}

TEST(GltfErrors, SurvivesDamagedText) {
  GltfText text = indexed_triangle();
  const size_t places = text.add_view<uint8_t>({2}), values = text.add_view<float>({0, 6, 7});
  text.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  text.json["nodes"].push_back({{"children", {0}},
                                {"rotation", {0, 0, 0, 1}},
                                {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  text.json["scenes"][0]["nodes"] = {1};
  text.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"color", {1, 1, 1}}}};
  EXPECT_EQ(error_of(text.dump()), "");
  fuzz(text.dump(), "damaged.gltf", 600);
}

TEST(GltfErrors, SurvivesDamagedBinary) {
  GltfText text = indexed_triangle();
  std::string json_chunk;
  {
    json whole = text.json;
    whole["buffers"] = {{{"byteLength", text.bytes.size()}}};
    json_chunk = whole.dump();
  }
  json_chunk.resize((json_chunk.size() + 3) / 4 * 4, ' ');
  std::string binary(text.bytes.begin(), text.bytes.end());
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string glb;
  const auto word = [&](size_t value) {
    for (int i = 0; i < 4; ++i) glb += static_cast<char>(value >> 8 * i & 255);
  };
  glb = "glTF";
  word(2), word(12 + 8 + json_chunk.size() + 8 + binary.size());
  word(json_chunk.size()), glb += "JSON" + json_chunk;
  word(binary.size()), glb += std::string("BIN\0", 4) + binary;
  EXPECT_EQ(error_of(glb, "whole.glb"), "");
  fuzz(glb, "damaged.glb", 600);
}

}  // namespace
}  // namespace vsslam
