// The colours of glTF files, with a small builder of such files.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/sim/mesh/gltf_files.h"

namespace hydroprint::mesh {
namespace {

using nlohmann::json;

/// A glTF file of one triangle, to which a test adds attributes and materials.
class GltfFile {
 public:
  GltfFile() {
    json_ = json::parse(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
      "nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{}}]}],
      "accessors":[],"bufferViews":[]})");
    attribute("POSITION", "VEC3", std::vector<float>{0, 0, 0, 8, 0, 0, 0, 8, 0});
  }

  json& operator[](const std::string& key) { return json_[key]; }
  json& primitive() { return json_["meshes"][0]["primitives"][0]; }

  template <class T>
  int view(const std::vector<T>& values) {
    bytes_.append((4 - bytes_.size() % 4) % 4, '\0');
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", values.size() * sizeof(T)}});
    for (const T value : values) put(bytes_, value);
    return static_cast<int>(json_["bufferViews"].size()) - 1;
  }

  template <class T>
  json& attribute(const std::string& name, const std::string& type, const std::vector<T>& values) {
    constexpr int kType = std::is_same_v<T, float>           ? 5126
                          : std::is_same_v<T, std::uint16_t> ? 5123
                                                             : 5121;
    const int at = view(values);
    json_["accessors"].push_back(
        {{"bufferView", at}, {"componentType", kType}, {"type", type}, {"count", 3}});
    primitive()["attributes"][name] = json_["accessors"].size() - 1;
    return json_["accessors"].back();
  }

  /// Adds a material and gives it to the triangle.
  void material(const std::string& text) {
    json_["materials"].push_back(json::parse(text));
    primitive()["material"] = json_["materials"].size() - 1;
  }

  /// Adds a texture with a picture in the file.
  void texture(const std::string& text = R"({"source":0})") {
    json_["textures"].push_back(json::parse(text));
    json_["images"] =
        json::parse(R"([{"uri":"data:image/png;base64,)" + base64("picture") + "\"}]");
  }

  [[nodiscard]] std::string text() const {
    json out = json_;
    out["buffers"] = {{{"byteLength", bytes_.size()},
                       {"uri", "data:application/octet-stream;base64," + base64(bytes_)}}};
    return out.dump();
  }

 private:
  json json_;
  std::string bytes_;
};

const std::vector<float> kUvs = {0, 0, 1, 0, 0, 1};
const std::vector<float> kOtherUvs = {0.5, 0.5, 0.75, 0.5, 0.5, 0.75};

Model read_file_of(const GltfFile& file) {
  const Folder folder;
  return read(folder.write("a.gltf", file.text()));
}

const Material& material_of(const Model& model) {
  return model.materials.at(static_cast<std::size_t>(model.triangle_material.at(0)));
}

float srgb(double linear) {
  return static_cast<float>(linear <= 0.0031308 ? 12.92 * linear
                                                : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

TEST(GltfColour, TheFactorIsOfTheFileOnly) {
  GltfFile file;
  file.material("{}");
  EXPECT_FALSE(material_of(read_file_of(file)).has_colour);
  GltfFile red;
  red.material(R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0.25,0,0.5]},
    "alphaMode":"MASK","alphaCutoff":0.3})");
  const Material m = material_of(read_file_of(red));
  EXPECT_TRUE(m.has_colour);
  EXPECT_TRUE(m.multiplies);
  EXPECT_TRUE(m.texture_as_stored);
  EXPECT_FALSE(m.uses_vertex_colours);
  expect_near(m.colour, {1, srgb(0.25), 0});
  EXPECT_EQ(m.alpha_mode, AlphaMode::kMask);
  EXPECT_FLOAT_EQ(m.alpha, 0.5F);
  EXPECT_FLOAT_EQ(m.alpha_cutoff, 0.3F);
}

TEST(GltfColour, APrimitiveWithoutMaterialHasNoColourUnlessItsVerticesHave) {
  EXPECT_FALSE(material_of(read_file_of({})).uses_vertex_colours);
  GltfFile file;
  file.attribute("COLOR_0", "VEC3", std::vector<float>{1, 0, 0, 0, 0.25, 0, 0, 0, 1});
  const Model m = read_file_of(file);
  EXPECT_TRUE(material_of(m).uses_vertex_colours);
  expect_near(m.vertex_colours.at(1), {0, srgb(0.25), 0});
}

TEST(GltfColour, ColoursOfVerticesMayBeIntegers) {
  GltfFile bytes;
  bytes.attribute(
      "COLOR_0", "VEC4",
      std::vector<std::uint8_t>{255, 51, 0, 255, 0, 0, 0, 255, 1, 2, 3, 4})["normalized"] = true;
  expect_near(read_file_of(bytes).vertex_colours.at(0), {1, srgb(0.2), 0});
  GltfFile shorts;  // without "normalized", which the format requires
  shorts.attribute("COLOR_0", "VEC3",
                   std::vector<std::uint16_t>{65535, 13107, 0, 0, 0, 0, 0, 0, 0});
  expect_near(read_file_of(shorts).vertex_colours.at(0), {1, srgb(0.2), 0});
}

TEST(GltfColour, TransparentVerticesAreBlendedWithWhite) {
  GltfFile file;
  file.attribute("COLOR_0", "VEC4", std::vector<float>{1, 0.5, 0, 0.5, 1, 1, 1, 1, 0, 0, 0, 0});
  file.material(
      R"({"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[0.5,1,1,0.5]}})");
  const Model m = read_file_of(file);
  // Opacity 0.25: a quarter of (0.5, 0.5, 0), three quarters of white.
  expect_near(m.vertex_colours.at(0), {srgb(0.875), srgb(0.875), srgb(0.75)});
  expect_near(m.vertex_colours.at(2), {1, 1, 1});
  expect_near(material_of(m).colour, {1, 1, 1});
  EXPECT_TRUE(has_warning(m.warnings, WarningCode::ALPHA_OVER_WHITE));
  GltfFile opaque;
  opaque.attribute("COLOR_0", "VEC4", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  expect_near(read_file_of(opaque).vertex_colours.at(0), {1, 0, 0});
}

TEST(GltfColour, TheTransformMayChooseTheCoordinates) {
  GltfFile file;
  file.attribute("TEXCOORD_0", "VEC2", kUvs);
  file.attribute("TEXCOORD_1", "VEC2", kOtherUvs);
  file.texture();
  file.material(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":0,
    "extensions":{"KHR_texture_transform":{"texCoord":1,"scale":[2,1]}}}}})");
  const Model m = read_file_of(file);
  EXPECT_EQ(m.corner_uvs.at(0)[1], Eigen::Vector2f(1.5, 0.5));
}

TEST(GltfColour, SpecularGlossinessGivesTheBaseColour) {
  GltfFile file;
  file.attribute("TEXCOORD_0", "VEC2", kUvs);
  file.attribute("TEXCOORD_1", "VEC2", kOtherUvs);
  file.texture();
  file.material(R"({"name":"clay","extensions":{"KHR_materials_pbrSpecularGlossiness":{
    "diffuseFactor":[0.25,1,1,1],"diffuseTexture":{"index":0,"texCoord":1}}}})");
  const Model m = read_file_of(file);
  EXPECT_FALSE(material_of(m).texture_bytes.empty());
  expect_near(material_of(m).colour, {srgb(0.25), 1, 1});
  EXPECT_EQ(m.corner_uvs.at(0)[1].x(), 0.75F);
  GltfFile both;  // the base colour of the core wins
  both.material(R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]},
    "extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0,1,0,1]}}})");
  expect_near(material_of(read_file_of(both)).colour, {1, 0, 0});
}

TEST(GltfColour, AnEmissionAloneIsTheColour) {
  GltfFile file;
  file.attribute("TEXCOORD_0", "VEC2", kUvs);
  file.texture();
  file.material(R"({"pbrMetallicRoughness":{"baseColorFactor":[0,0,0,1]},
    "emissiveFactor":[1,0.25,1],"emissiveTexture":{"index":0}})");
  const Model m = read_file_of(file);
  EXPECT_FALSE(material_of(m).texture_bytes.empty());
  expect_near(material_of(m).colour, {1, srgb(0.25), 1});
  EXPECT_TRUE(has_warning(m.warnings, WarningCode::EMISSIVE_COLOUR_USED));
  GltfFile painted;
  painted.material(
      R"({"pbrMetallicRoughness":{"baseColorFactor":[0,1,0,1]},"emissiveFactor":[1,0,0]})");
  expect_near(material_of(read_file_of(painted)).colour, {0, 1, 0});
}

TEST(GltfColour, TexturesThatNeedAnExtensionAreNotUnderstoodWithoutAnotherSource) {
  for (const std::string extension :
       {"EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds"}) {
    GltfFile file;
    file.attribute("TEXCOORD_0", "VEC2", kUvs);
    file.texture(R"({"extensions":{")" + extension + R"(":{"source":0}}})");
    file.material(R"({"name":"wood","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,1],
      "baseColorTexture":{"index":0}}})");
    const Model m = read_file_of(file);
    EXPECT_FALSE(material_of(m).has_colour);
    ASSERT_EQ(m.not_understood.size(), 1U);
    EXPECT_NE(m.not_understood[0].find("material \"wood\": its texture needs " + extension),
              std::string::npos);
    file["textures"][0]["source"] = 0;
    EXPECT_FALSE(material_of(read_file_of(file)).texture_bytes.empty());
  }
}

TEST(GltfColour, TexturesThatDoNotExistAreNotUnderstood) {
  for (const std::string texture : {R"({"source":7})", R"({})"}) {
    GltfFile file;
    file.texture(texture);
    file.material(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})");
    EXPECT_EQ(read_file_of(file).not_understood.size(), 1U);
  }
  GltfFile file;
  file.material(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":3}}})");
  EXPECT_EQ(read_file_of(file).not_understood.size(), 1U);
}

TEST(GltfColour, UnknownExtensionsOfAColourlessMaterialAreNamed) {
  GltfFile file;
  file.material(R"({"name":"x","extensions":{"ACME_materials_paint":{"colour":[1,0,0]}}})");
  EXPECT_EQ(read_file_of(file).not_understood,
            std::vector<std::string>{"material \"x\": ACME_materials_paint"});
}

/// Replaces elements of an attribute by sparse ones; without a base view if `alone`.
template <class T, class Index>
void make_sparse(GltfFile& file, json& accessor, const std::vector<Index>& indices,
                 const std::vector<T>& values, bool alone) {
  const int index_view = file.view(indices), value_view = file.view(values);
  accessor["sparse"] = {
      {"count", indices.size()},
      {"indices",
       {{"bufferView", index_view}, {"componentType", sizeof(Index) == 1 ? 5121 : 5123}}},
      {"values", {{"bufferView", value_view}}}};
  if (alone) accessor.erase("bufferView");
}

TEST(GltfColour, SparseAccessorsAreRead) {
  for (const bool alone : {false, true}) {
    GltfFile file;
    json accessor = file.attribute("COLOR_0", "VEC3", std::vector<float>(9, 0.25F));
    make_sparse<float, std::uint8_t>(file, accessor, {0, 2}, {1, 0, 0, 0, 0, 1}, alone);
    file["accessors"][1] = accessor;
    const Model m = read_file_of(file);
    expect_near(m.vertex_colours.at(0), {1, 0, 0});
    const float base = alone ? 0 : srgb(0.25);
    expect_near(m.vertex_colours.at(1), {base, base, base});
    expect_near(m.vertex_colours.at(2), {0, 0, 1});
  }
  GltfFile file;
  json accessor = file["accessors"][0];
  make_sparse<float, std::uint16_t>(file, accessor, {1}, {5, 6, 7}, false);
  file["accessors"][0] = accessor;
  const Model m = read_file_of(file);
  EXPECT_EQ(m.vertices.at(1), Eigen::Vector3d(5, 6, 7));
  EXPECT_EQ(m.vertices.at(2), Eigen::Vector3d(0, 8, 0));
}

TEST(GltfColour, BrokenAccessorsAreRefused) {
  const Folder folder;
  const auto refused = [&](const std::function<void(json&)>& change) {
    GltfFile file;
    json accessor = file.attribute("COLOR_0", "VEC3", std::vector<float>(9, 0.25F));
    make_sparse<float, std::uint8_t>(file, accessor, {0, 2}, {1, 0, 0, 0, 0, 1}, false);
    change(accessor);
    file["accessors"][1] = accessor;
    expect_refused(folder.write("a.gltf", file.text()), "mesh 0 primitive 0: its COLOR_0");
  };
  refused([](json& a) { a["sparse"]["count"] = 3; });
  refused([](json& a) { a["sparse"]["count"] = -1; });
  refused([](json& a) { a["sparse"]["indices"]["bufferView"] = 9; });
  refused([](json& a) { a["sparse"]["values"]["byteOffset"] = 20; });
  refused([](json& a) { a["sparse"]["indices"]["componentType"] = 5126; });
  refused([](json& a) { a["count"] = 2; });
  refused([](json& a) {
    a.erase("bufferView");
    a["count"] = 2'000'000'000;
  });
  refused([](json& a) { a["type"] = "VEC2"; });
  refused([](json& a) { a["bufferView"] = 77; });
  for (const std::vector<std::uint8_t>& indices :
       {std::vector<std::uint8_t>{2, 0}, std::vector<std::uint8_t>{1, 1},
        std::vector<std::uint8_t>{0, 3}}) {
    GltfFile file;
    json accessor = file.attribute("COLOR_0", "VEC3", std::vector<float>(9, 0.25F));
    make_sparse<float>(file, accessor, indices, {1, 0, 0, 0, 0, 1}, false);
    file["accessors"][1] = accessor;
    expect_refused(folder.write("b.gltf", file.text()), "its COLOR_0");
  }
}

TEST(GltfNames, BuffersAndImagesMayDifferInCase) {
  const Folder folder;
  folder.write("Shape.BIN", tetrahedron_buffer());
  folder.write("Skin.PNG", "not looked at");
  const Model m = read(
      folder.write("a.gltf", tetrahedron_gltf({{"uri", "shape.bin"},
                                               {"attributes", ",\"TEXCOORD_0\":2"},
                                               {"material", ",\"material\":0"},
                                               {"extra", R"(,"materials":[{"pbrMetallicRoughness":{
                                    "baseColorTexture":{"index":0}}}],"textures":[{"source":0}],
                                    "images":[{"uri":"skin.png"}])"}})));
  EXPECT_EQ(m.triangles.size(), 4U);
  EXPECT_EQ(material_of(m).texture, folder.path() / "Skin.PNG");
  EXPECT_EQ(std::ranges::count_if(
                m.warnings, [](const Warning& w) { return w.code == WarningCode::SIMILAR_NAME; }),
            2);
  expect_refused(folder.write("b.gltf", tetrahedron_gltf({{"uri", "../shape.bin"}})), "");
}

TEST(GltfColour, TenThousandMaterialsAreReadAtOnce) {
  GltfFile file;
  file.texture();
  const json primitive = file.primitive();
  for (int i = 0; i < 10'000; ++i) {
    file["materials"].push_back(
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {i / 10'000.0, 0, 0, 1}}, {"baseColorTexture", {{"index", 0}}}}}});
    file["meshes"][0]["primitives"][static_cast<std::size_t>(i)] = primitive;
    file["meshes"][0]["primitives"][static_cast<std::size_t>(i)]["material"] = i;
  }
  EXPECT_EQ(read_file_of(file).materials.size(), 10'000U);
}

}  // namespace
}  // namespace hydroprint::mesh
