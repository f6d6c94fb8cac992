// Models as the large programs write them: each test is one kind, with values of its own.

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "sim/mesh/make_surface.h"
#include "tests/sim/mesh/files.h"

namespace hydroprint::mesh {
namespace {

const std::string kTriangle = "v 0 0 0\nv 8 0 0\nv 0 8 0\n";
const std::string kMark = "\xEF\xBB\xBF";

TEST(Dialects, ByteOrderMarksAreSkipped) {
  const Folder folder;
  folder.write("m.mtl", kMark + "newmtl red\nKd 1 0 0\n");
  const Model obj =
      read(folder.write("a.obj", kMark + "mtllib m.mtl\n" + kTriangle + "usemtl red\nf 1 2 3\n"));
  EXPECT_TRUE(obj.materials.at(0).has_colour);
  EXPECT_EQ(read(folder.write("b.obj", kMark + kTriangle + "f 1 2 3\n")).vertices.size(), 3U);
  EXPECT_EQ(read(folder.write("a.stl", kMark + tetrahedron_stl_text())).triangles.size(), 4U);
  EXPECT_EQ(read(folder.write("a.ply", kMark + ply_header("ascii") + kTetrahedronPlyText))
                .triangles.size(),
            4U);
}

TEST(Dialects, SevenNumbersOfAVertexEndWithAnAlpha) {
  const Folder folder;
  const Model m = read(folder.write(
      "a.obj", "v 0 0 0 0.1 0.2 0.3 1\nv 8 0 0 0.4 0.5 0.6 0\nv 0 8 0 0.7 0.8 0.9 0.5\nf 1 2 3\n"));
  ASSERT_EQ(m.vertex_colours.size(), 3U);
  expect_near(m.vertex_colours[0], {0.1F, 0.2F, 0.3F});
  expect_near(m.vertex_colours[1], {0.4F, 0.5F, 0.6F});
}

TEST(Dialects, ColoursOfVerticesFrom0To255AreScaled) {
  const Folder folder;
  const Model m =
      read(folder.write("a.obj", "v 0 0 0 255 0 51\nv 8 0 0 0 102 0\nv 0 8 0 1 1 1\nf 1 2 3\n"));
  expect_near(m.vertex_colours.at(0), {1, 0, 0.2F});
  expect_near(m.vertex_colours.at(1), {0, 0.4F, 0});
  EXPECT_TRUE(has_warning(m.warnings, WarningCode::COLOURS_SCALED));
  const Model bright =
      read(folder.write("b.obj", "v 0 0 0 1.02 0 0\nv 8 0 0 0 1 0\nv 0 8 0 0 0 1\nf 1 2 3\n"));
  expect_near(bright.vertex_colours.at(0), {1, 0, 0});
  EXPECT_TRUE(has_warning(bright.warnings, WarningCode::COLOURS_CLAMPED));
}

TEST(Dialects, VerticesWithoutAColourAmongOthersAreWhite) {
  const Folder folder;
  const Model m = read(folder.write("a.obj", "v 0 0 0\nv 8 0 0 1 0 0\nv 0 8 0\nf 1 2 3\n"));
  expect_near(m.vertex_colours.at(0), {1, 1, 1});
  expect_near(m.vertex_colours.at(1), {1, 0, 0});
  EXPECT_TRUE(has_warning(m.warnings, WarningCode::VERTEX_COLOURS_IN_PART));
}

TEST(Dialects, PolypaintOfZBrushIsRead) {
  const Folder folder;
  const Model m =
      read(folder.write("a.obj", kTriangle + "#MRGB ffff0000ff00ff00\n#MRGB ff3366cc\nf 1 2 3\n"));
  ASSERT_EQ(m.vertex_colours.size(), 3U);
  expect_near(m.vertex_colours[0], {1, 0, 0});
  expect_near(m.vertex_colours[1], {0, 1, 0});
  expect_near(m.vertex_colours[2], {0.2F, 0.4F, 0.8F});
  const Model short_of = read(folder.write("b.obj", kTriangle + "#MRGB ffff0000\nf 1 2 3\n"));
  EXPECT_TRUE(short_of.vertex_colours.empty());
  EXPECT_EQ(short_of.not_understood.size(), 1U);
}

TEST(Dialects, NumbersBesideTheShapeMayBeNaN) {
  const Folder folder;
  const Model obj = read(folder.write(
      "a.obj",
      "v 0 0 0 nan 0 0\nv 8 0 0 1 0 0\nv 0 8 0 1 -1.#IND 0\nvn nan 0 1\nf 1//1 2//1 3//1\n"));
  expect_near(obj.vertex_colours.at(0), {1, 1, 1});
  expect_near(obj.vertex_colours.at(1), {1, 0, 0});
  EXPECT_TRUE(has_warning(obj.warnings, WarningCode::COLOURS_NOT_NUMBERS));
  const auto ply = [&](const std::string& x, const std::string& normal) {
    return folder.write("a.ply",
                        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                        "property float y\nproperty float z\nproperty float nx\n"
                        "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                            x + " 0 0 " + normal + "\n8 0 0 1\n0 8 0 1\n3 0 1 2\n");
  };
  for (const std::string nan : {"nan", "-nan(ind)", "1.#QNAN", "-1.#IND", "inf"}) {
    EXPECT_EQ(read(ply("0", nan)).triangles.size(), 1U) << nan;
    expect_refused(ply(nan, "0"), "vertex 0: its x is not a finite number");
  }
  expect_refused(ply("0", "up"), "vertex 0: is truncated, or its nx is not a number");
}

TEST(Dialects, FacesWithoutAMaterialNameHaveNone) {
  const Folder folder;
  folder.write("m.mtl", "newmtl red\nKd 1 0 0\n");
  const Model m =
      read(folder.write("a.obj", "mtllib m.mtl\n" + kTriangle +
                                     "v 8 8 0\nusemtl   red \nf 1 2 3\nusemtl\nf 2 4 3\n"));
  ASSERT_EQ(m.triangle_material.size(), 2U);
  EXPECT_TRUE(m.materials[m.triangle_material[0]].has_colour);
  EXPECT_FALSE(m.materials[m.triangle_material[1]].has_colour);
  EXPECT_TRUE(m.warnings.empty());
}

TEST(Dialects, AMaterialFileThatNoFaceNeedsMayBeMissingOrEmpty) {
  const Folder folder;
  folder.write("empty.mtl", "");
  const std::string coloured = "v 0 0 0 1 0 0\nv 8 0 0 0 1 0\nv 0 8 0 0 0 1\n";
  for (const std::string name : {"empty.mtl", "gone.mtl"}) {
    const Model bare =
        read(folder.write("a.obj", "mtllib " + name + "\n" + kTriangle + "f 1 2 3\n"));
    EXPECT_FALSE(has_warning(bare.warnings, WarningCode::MATERIAL_FILE_MISSING));
    const Model m =
        read(folder.write("b.obj", "mtllib " + name + "\n" + coloured + "usemtl skin\nf 1 2 3\n"));
    EXPECT_FALSE(has_warning(m.warnings, WarningCode::MATERIAL_FILE_MISSING));
    EXPECT_FALSE(has_warning(m.warnings, WarningCode::MATERIAL_MISSING));
    EXPECT_EQ(m.vertex_colours.size(), 3U);
  }
}

TEST(Dialects, NamesMayDifferInCaseAndUnicodeForm) {
  const Folder folder;
  // In the file names composed and in capitals; in the model decomposed and small.
  folder.write("B\u00c4R.MTL", "newmtl Fell B\u00e4r\nmap_Kd Fell.PNG\n");
  folder.write("fell.png", "not looked at");
  const Model m = read(folder.write(
      "a.obj", "mtllib ba\u0308r.mtl\n" + kTriangle + "usemtl FELL BA\u0308R\nf 1 2 3\n"));
  EXPECT_EQ(m.materials.at(0).texture, folder.path() / "fell.png");
  EXPECT_EQ(std::ranges::count_if(
                m.warnings, [](const Warning& w) { return w.code == WarningCode::SIMILAR_NAME; }),
            3);
}

TEST(Dialects, ANameWithTwoCandidatesIsNotGuessed) {
  const Folder folder;
  folder.write("m.mtl", "newmtl skin\nmap_Kd SKIN.png\n");
  folder.write("Skin.png", "");
  folder.write("skin.PNG", "");
  const Model m =
      read(folder.write("a.obj", "mtllib m.mtl\n" + kTriangle + "usemtl skin\nf 1 2 3\n"));
  EXPECT_EQ(m.materials.at(0).texture, folder.path() / "SKIN.png");
  EXPECT_FALSE(has_warning(m.warnings, WarningCode::SIMILAR_NAME));
}

TEST(Dialects, NamesInLatin1AreFound) {
  const Folder folder;
  folder.write("m.mtl", "newmtl skin\nmap_Kd H\xf6lzern.png\n");
  folder.write("H\u00f6lzern.png", "");
  const Model m =
      read(folder.write("a.obj", "mtllib m.mtl\n" + kTriangle + "usemtl skin\nf 1 2 3\n"));
  EXPECT_EQ(m.materials.at(0).texture, folder.path() / "H\u00f6lzern.png");
}

TEST(Dialects, TexturesInTilesAreNotUnderstood) {
  const Folder folder;
  folder.write("m.mtl", "newmtl skin\nKd 0.8 0.8 0.8\nmap_Kd wood_<UDIM>.png\n");
  const Model m =
      read(folder.write("a.obj", "mtllib m.mtl\n" + kTriangle + "usemtl skin\nf 1 2 3\n"));
  EXPECT_FALSE(m.materials.at(0).has_colour);
  EXPECT_TRUE(m.materials.at(0).texture.empty());
  ASSERT_EQ(m.not_understood.size(), 1U);
  EXPECT_NE(m.not_understood[0].find("UDIM"), std::string::npos);
}

TEST(Dialects, AsciiStlMayBeSpelledOtherwise) {
  const Folder folder;
  const std::string usual = tetrahedron_stl_text();
  std::string capitals = usual;
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::string apart = usual;
  for (const std::string word : {"endsolid", "endfacet", "endloop"})
    for (auto at = apart.find(word); at != apart.npos; at = apart.find(word, at))
      apart.replace(at, word.size(), "end " + word.substr(3));
  std::string mac = usual;
  for (char& c : mac)
    if (c == '\n') c = '\r';
  const Model expected = read(folder.write("usual.stl", usual));
  for (const std::string& text :
       {"  " + usual, "\r\n\t" + usual, capitals, apart, mac, usual + "\n\n  \n"}) {
    const Model m = read(folder.write("a.stl", text));
    EXPECT_EQ(m.vertices, expected.vertices);
    EXPECT_EQ(m.triangles, expected.triangles);
  }
}

/// A binary STL of the tetrahedron with these attribute bytes for all facets but the first.
std::string stl_with(const std::string& header, std::uint16_t first, std::uint16_t others) {
  std::string bytes = tetrahedron_stl();
  bytes.replace(0, header.size(), header);
  for (std::size_t f = 0; f < 4; ++f) {
    const std::uint16_t value = f == 0 ? first : others;
    std::memcpy(bytes.data() + 84 + 50 * f + 48, &value, 2);
  }
  return bytes;
}

TEST(Dialects, ColoursOfMagicsInStlAreRead) {
  const Folder folder;
  const std::string header = std::string("COLOR=") + "\xff\x33\x01\xff";  // R G B A
  const std::uint16_t own = 31 | 10 << 5 | 4 << 10;                       // red is lowest
  const Model m = read(folder.write("a.stl", stl_with(header, own, 0x8000)));
  ASSERT_EQ(m.vertex_colours.size(), 12U);
  for (int k = 0; k < 3; ++k) expect_near(m.vertex_colours[k], {1, 10 / 31.0F, 4 / 31.0F});
  expect_near(m.vertex_colours[3], {1, 0.2F, 1 / 255.0F});
  const Model whole = read(folder.write("b.stl", stl_with(header, 0, 0)));
  expect_near(whole.vertex_colours.at(0), {1, 0.2F, 1 / 255.0F});
}

TEST(Dialects, ColoursOfVisCamInStlAreRead) {
  const Folder folder;
  const std::uint16_t own = 0x8000 | 31 << 10 | 10 << 5 | 4;  // blue is lowest
  const Model m = read(folder.write("a.stl", stl_with("", own, 7)));
  ASSERT_EQ(m.vertex_colours.size(), 12U);
  expect_near(m.vertex_colours[2], {1, 10 / 31.0F, 4 / 31.0F});
  expect_near(m.vertex_colours[3], {1, 1, 1});
  EXPECT_TRUE(has_warning(m.warnings, WarningCode::FACETS_WITHOUT_COLOUR));
  const Model odd = read(folder.write("b.stl", stl_with("", 7, 9)));
  EXPECT_TRUE(odd.vertex_colours.empty());
  EXPECT_EQ(odd.not_understood.size(), 1U);
  EXPECT_TRUE(read(folder.write("c.stl", tetrahedron_stl())).not_understood.empty());
}

TEST(Dialects, CoordinatesOfAsciiFilesKeepAllDigits) {
  const Folder folder;
  std::string stl = tetrahedron_stl_text();
  stl.replace(stl.find("vertex 0 0 0"), 12, "vertex 0.123456789012 0 0");
  EXPECT_EQ(read(folder.write("a.stl", stl)).vertices[0].x(), 0.123456789012);
}

/// ASCII PLY of two triangles, with these properties of vertices and faces and their values.
std::string ply_of(const std::string& vertex_properties, const std::array<std::string, 4>& vertices,
                   const std::string& face_properties, const std::array<std::string, 2>& faces,
                   const std::string& comments = "") {
  std::string text = "ply\nformat ascii 1.0\n" + comments +
                     "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
                     vertex_properties +
                     "element face 2\nproperty list uchar int vertex_indices\n" + face_properties +
                     "end_header\n";
  const std::array<std::string, 4> places = {"0 0 0", "8 0 0", "0 8 0", "8 8 0"};
  for (std::size_t i = 0; i < 4; ++i) text += places[i] + " " + vertices[i] + "\n";
  return text + "3 0 1 2 " + faces[0] + "\n3 1 3 2 " + faces[1] + "\n";
}

TEST(Dialects, ColoursOfPlyVerticesHaveManyNamesAndTypes) {
  const Folder folder;
  const auto colours = [&](const std::string& type, const std::array<std::string, 3>& names,
                           const std::string& value) {
    std::string properties;
    for (const auto& name : names) properties += "property " + type + " " + name + "\n";
    const Model m =
        read(folder.write("a.ply", ply_of(properties, {value, value, value, value}, "", {"", ""})));
    return m.vertex_colours.empty() ? Eigen::Vector3f(-1, -1, -1) : m.vertex_colours[0];
  };
  const std::array<std::string, 3> usual = {"red", "green", "blue"};
  expect_near(colours("uchar", usual, "255 51 0"), {1, 0.2F, 0});
  expect_near(colours("ushort", usual, "65535 13107 0"), {1, 0.2F, 0});
  expect_near(colours("float", usual, "1 0.2 0"), {1, 0.2F, 0});
  expect_near(colours("int", usual, "255 51 0"), {1, 0.2F, 0});
  expect_near(colours("uchar", {"diffuse_red", "diffuse_green", "diffuse_blue"}, "255 51 0"),
              {1, 0.2F, 0});
  expect_near(colours("float", {"r", "g", "b"}, "1 0.2 0"), {1, 0.2F, 0});
  expect_near(colours("uchar", {"ambient_red", "ambient_green", "ambient_blue"}, "255 51 0"),
              {-1, -1, -1});
}

TEST(Dialects, ColoursOfPlyFacesAreRead) {
  const Folder folder;
  const Model m = read(folder.write(
      "a.ply",
      ply_of(
          "", {"", "", "", ""},
          "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n",
          {"255 0 0 255", "0 51 255 255"})));
  ASSERT_EQ(m.triangle_colours.size(), 2U);
  expect_near(m.triangle_colours[0], {1, 0, 0});
  expect_near(m.triangle_colours[1], {0, 0.2F, 1});
}

TEST(Dialects, UnknownColoursOfAPlyAreNotUnderstood) {
  const Folder folder;
  const Model m = read(
      folder.write("a.ply", ply_of("property uint rgba\n", {"1", "2", "3", "4"}, "", {"", ""})));
  EXPECT_EQ(m.not_understood, std::vector<std::string>{"property rgba of each vertex"});
}

TEST(Dialects, MeshLabsTextureCoordinatesPerFaceAreRead) {
  const Folder folder;
  folder.write("two.png", "");
  const Model m = read(folder.write(
      "a.ply",
      ply_of("", {"", "", "", ""}, "property list uchar float texcoord\nproperty int texnumber\n",
             {"6 0 0 1 0 0 1 1", "6 0.5 0 1 0.25 0 1 -1"},
             "comment TextureFile one.png\ncomment TextureFile two.png \n")));
  ASSERT_EQ(m.corner_uvs.size(), 2U);
  EXPECT_EQ(m.corner_uvs[1][1], Eigen::Vector2f(1, 0.25));
  EXPECT_EQ(m.materials.at(m.triangle_material.at(0)).texture, folder.path() / "two.png");
  EXPECT_TRUE(m.materials.at(m.triangle_material.at(1)).texture.empty());
}

TEST(Dialects, FacesWithoutCoordinatesInAPlyHaveNoTexture) {
  const Folder folder;
  const Model m = read(
      folder.write("a.ply", ply_of("", {"", "", "", ""}, "property list uchar float texcoord\n",
                                   {"6 0 0 1 0 0 1", "0"}, "comment TextureFile one.png\n")));
  EXPECT_FALSE(m.materials.at(m.triangle_material.at(0)).texture.empty());
  EXPECT_TRUE(m.materials.at(m.triangle_material.at(1)).texture.empty());
  EXPECT_TRUE(has_warning(m.warnings, WarningCode::FACES_WITHOUT_UV));
}

TEST(Dialects, CoordinatesOfPlyMayBeIntegersAndLinesMayEndWithCr) {
  const Folder folder;
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty short y\n"
      "property uchar z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n\n8 0 0\n0 -8 200\n3 0 1 2\n";
  EXPECT_EQ(read(folder.write("a.ply", text)).vertices.at(2), Eigen::Vector3d(0, -8, 200));
  for (char& c : text)
    if (c == '\n') c = '\r';
  EXPECT_EQ(read(folder.write("b.ply", text)).vertices.at(2), Eigen::Vector3d(0, -8, 200));
}

TEST(Dialects, ModelsInMapCoordinatesAreTheSameShapes) {
  const Folder folder;
  const auto cube = [](double x0, double y0, double z0) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
      char line[120];
      std::snprintf(line, sizeof line, "v %.6f %.6f %.6f\n", x0 + 0.02 * (i & 1),
                    y0 + 0.02 * (i >> 1 & 1), z0 + 0.02 * (i >> 2 & 1));
      text += line;
    }
    return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  };
  const Model near = read(folder.write("near.obj", cube(0, 0, 0)), 1000);
  const Model far = read(folder.write("far.obj", cube(512345.5, 5403210.25, 321.125)), 1000);
  EXPECT_FALSE(has_warning(near.warnings, WarningCode::FAR_FROM_ORIGIN));
  EXPECT_TRUE(has_warning(far.warnings, WarningCode::FAR_FROM_ORIGIN));
  const auto a = make_surface(near, 2, {}), b = make_surface(far, 2, {});
  ASSERT_TRUE(a);
  ASSERT_TRUE(b);
  EXPECT_TRUE(b->closed);
  EXPECT_FALSE(has_warning(b->warnings, WarningCode::INSIDE_OUT));
  ASSERT_EQ(a->triangles, b->triangles);
  const Eigen::Vector3d shift(512345500, 5403210250, 321125);
  for (std::size_t i = 0; i < a->points.size(); ++i)
    EXPECT_LT((b->points[i] - shift - a->points[i]).norm(), 1e-5);
  for (std::size_t t = 0; t < a->triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT((b->corner_normals[t][k] - a->corner_normals[t][k]).norm(), 1e-4);
  expect_refused(folder.write("out.obj", cube(1e11, 0, 0)), "more than 10,000 km");
  expect_refused(folder.write("stray.obj", cube(0, 0, 0) + "v 9e6 0 0\n"), "vertex 8: ");
}

TEST(Dialects, ControlCharactersInNamesDoNotReachErrors) {
  const Folder folder;
  folder.write("m.mtl", "newmtl a\nKd \x1b[31m 0 0\n");
  const auto model = read_model(
      folder.write("a.obj", "mtllib m.mtl\n" + kTriangle + "usemtl a\nf 1 2 3\n"), 1, {});
  ASSERT_FALSE(model);
  const std::string& message = model.error().message;
  EXPECT_NE(message.find("m.mtl: line 2: Kd needs numbers"), std::string::npos) << message;
  EXPECT_TRUE(std::ranges::none_of(message, [](char c) { return c >= 0 && c < ' '; }));
}

}  // namespace
}  // namespace hydroprint::mesh
