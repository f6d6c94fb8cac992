#include <Eigen/Geometry>
#include <array>
#include <sstream>

#include "tests/sim/mesh/files.h"

namespace hydroprint::mesh {
namespace {

double area(const Model& m) {
  double sum = 0;
  for (const auto& t : m.triangles)
    sum +=
        (m.vertices[t[1]] - m.vertices[t[0]]).cross(m.vertices[t[2]] - m.vertices[t[0]]).norm() / 2;
  return sum;
}

TEST(ReadObj, VerticesKeepTheFilesOrderEvenIfUnused) {
  const Folder folder;
  const Model m =
      read(folder.write("a.obj", "v 9 8 7\n" + std::string("v 0 0 0\nv 0 1 0\nv 1 0 0\n") +
                                     "v 5 5 5\nf 4 3 2\n"),
           2);
  ASSERT_EQ(m.vertices.size(), 5U);
  EXPECT_EQ(m.vertices[0], Eigen::Vector3d(18, 16, 14));
  EXPECT_EQ(m.vertices[3], Eigen::Vector3d(2, 0, 0));
  ASSERT_EQ(m.triangles.size(), 1U);
  EXPECT_EQ(m.triangles[0], Eigen::Vector3i(3, 2, 1));
  EXPECT_TRUE(m.corner_uvs.empty());
  EXPECT_TRUE(m.triangle_material.empty());
}

TEST(ReadObj, NegativeIndicesCountFromTheLine) {
  const Folder folder;
  const Model m =
      read(folder.write("a.obj",
                        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                        "f -3/-3 -2/-2 -1/-1\nv 0 0 1\nvt .5 .5\nf -4/-4 -1/-1 -3/-3\n"));
  ASSERT_EQ(m.triangles.size(), 2U);
  EXPECT_EQ(m.triangles[0], Eigen::Vector3i(0, 1, 2));
  EXPECT_EQ(m.triangles[1], Eigen::Vector3i(0, 3, 1));
  EXPECT_EQ(m.corner_uvs[1][1], Eigen::Vector2f(0.5, 0.5));
}

TEST(ReadObj, ConcavePolygonsAreTiledWithinTheirOutline) {
  const Folder folder;
  // First an arrow head, listed from a corner from which a fan would leave the outline; then an L.
  const Model arrow =
      read(folder.write("a.obj", "v 0 3 0\nv 0 0 0\nv 3 0 0\nv 1 1 0\nf 1 2 3 4\n"));
  EXPECT_EQ(arrow.triangles.size(), 2U);
  EXPECT_NEAR(area(arrow), 3, 1e-12);
  const Model ell = read(folder.write(
      "b.obj", "v 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nv 0 0 0\nf 1 2 3 4 5 6\n"));
  EXPECT_EQ(ell.triangles.size(), 4U);
  EXPECT_NEAR(area(ell), 4, 1e-12);
  for (const auto& t : ell.triangles)
    EXPECT_GT((ell.vertices[t[1]] - ell.vertices[t[0]])
                  .cross(ell.vertices[t[2]] - ell.vertices[t[0]])
                  .z(),
              0);
}

TEST(ReadObj, PolygonsOfManyCornersAreReadWhole) {
  const Folder folder;
  std::ostringstream text;
  std::ostringstream face;
  for (int i = 0; i < 300; ++i) {
    const double angle = i * M_PI / 150;
    text << "v " << 10 * std::cos(angle) << " " << 10 * std::sin(angle) << " 0\n";
    face << " " << i + 1;
  }
  text << "f" << face.str() << "\n";
  const Model m = read(folder.write("a.obj", text.str()));
  EXPECT_EQ(m.triangles.size(), 298U);
  EXPECT_NEAR(area(m), 100 * M_PI, 0.1);
}

TEST(ReadObj, MaterialsTexturesAndOptionsAreFound) {
  const Folder folder;
  folder.write("my paint.mtl",
               "newmtl glossy red\nKd 1 0 0\nnewmtl photo\nKd 0.5 0.5 0.5\n"
               "map_Kd -clamp on -s 2 4 1 -o 0.5 0 0 my picture file.png\nnewmtl plain\n");
  folder.write("my picture file.png", "not looked at");
  const Model m = read(
      folder.write("a.obj",
                   "mtllib my paint.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0.25 0.25\n"
                   "f 1/1 2/1 3/1\nusemtl glossy red\nf 1/1 2/1 4/1\nusemtl photo\nf 1/1 3/1 4/1\n"
                   "usemtl plain\nf 2/1 3/1 4/1\nusemtl glossy red\nf 2/1 4/1 3/1\n"));
  ASSERT_EQ(m.triangle_material.size(), 5U);
  const auto material = [&](int t) { return m.materials[m.triangle_material[t]]; };
  EXPECT_FALSE(material(0).has_colour);
  EXPECT_EQ(material(1).name, "glossy red");
  EXPECT_TRUE(material(1).has_colour);
  EXPECT_EQ(material(1).colour, Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(material(2).texture, folder.path() / "my picture file.png");
  EXPECT_EQ(material(2).wrap_u, Wrap::kClamp);
  EXPECT_EQ(m.corner_uvs[2][0], Eigen::Vector2f(1, 1));
  EXPECT_EQ(m.corner_uvs[1][0], Eigen::Vector2f(0.25, 0.25));
  EXPECT_FALSE(material(3).has_colour);
  EXPECT_EQ(m.triangle_material[4], m.triangle_material[1]);
  EXPECT_TRUE(m.warnings.empty());
}

TEST(ReadObj, TexturesAreFoundByWindowsPathsToo) {
  const Folder folder;
  folder.write("a.mtl", "newmtl m\nmap_Kd C:\\Users\\me\\picture.png\n");
  folder.write("picture.png", "");
  const Model m = read(folder.write("a.obj", "mtllib a.mtl\nusemtl m\n" + kTetrahedronObj));
  EXPECT_EQ(m.materials.at(0).texture, folder.path() / "picture.png");
}

TEST(ReadObj, AMissingMaterialFileIsAWarning) {
  const Folder folder;
  const Model m = read(folder.write("a.obj", "mtllib gone.mtl\nusemtl m\n" + kTetrahedronObj));
  EXPECT_TRUE(has_warning(m.warnings, WarningCode::MATERIAL_FILE_MISSING));
  EXPECT_FALSE(m.materials.at(0).has_colour);
}

TEST(ReadObj, AMissingOrEmptyMaterialIsAWarning) {
  const Folder folder;
  folder.write("empty.mtl", "# nothing\n");
  const Model m = read(folder.write("a.obj", "mtllib empty.mtl\nusemtl m\n" + kTetrahedronObj));
  EXPECT_TRUE(has_warning(m.warnings, WarningCode::MATERIAL_MISSING));
}

TEST(ReadObj, VertexColoursAreKept) {
  const Folder folder;
  const Model m =
      read(folder.write("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 0.5\nf 1 2 3\n"));
  ASSERT_EQ(m.vertex_colours.size(), 3U);
  EXPECT_EQ(m.vertex_colours[2], Eigen::Vector3f(0, 0, 0.5));
}

TEST(ReadObj, FacesWithoutTextureCoordinatesAmongOthersAreReported) {
  const Folder folder;
  const Model m = read(folder.write(
      "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 1 1\nf 1/1 2/1 3/1\nf 1//1 2//1 4//1\n"));
  EXPECT_EQ(m.corner_uvs.size(), 2U);
  EXPECT_TRUE(has_warning(m.warnings, WarningCode::FACES_WITHOUT_UV));
}

TEST(ReadObj, ContinuedLinesAndDosLineEndsAreRead) {
  const Folder folder;
  EXPECT_EQ(read(folder.write("a.obj", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 \\\r\n 2 3\r\n"))
                .triangles.size(),
            1U);
  EXPECT_EQ(
      read(folder.write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 \\\n1 0\nf 1 2 \\\n3")).triangles.size(),
      1U);
}

TEST(ReadObj, TrailingCommentsAreIgnored) {
  const Folder folder;
  const std::string plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
  const Model expected = read(folder.write("plain.obj", plain));
  for (const std::string end : {"\n", "\r\n"}) {
    const std::string text = "#f 1 2 3 # none" + end + "v 0 0 0 # 4 5" + end + "v 1 0 0 #1 1 1" +
                             end + "v 0 1 0 # # 2" + end + "vt 0 0 # 9" + end + "vt 1 0 #9" + end +
                             "vt 0 1 # 9" + end + "\tf 1/1 2/2 3/3 # 1/1 f 2/2 # 3" + end +
                             "# f 9 9 9" + end;
    const Model m = read(folder.write("a.obj", text));
    EXPECT_EQ(m.vertices, expected.vertices);
    EXPECT_EQ(m.triangles, expected.triangles);
    EXPECT_EQ(m.corner_uvs, expected.corner_uvs);
    EXPECT_TRUE(m.vertex_colours.empty());
  }
  EXPECT_EQ(read(folder.write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3#end")).triangles.size(),
            1U);
  expect_refused(folder.write("c.obj", kTetrahedronObj + "f 1 2 # 3\n"),
                 "line 9: a face has fewer than three");
}

TEST(ReadObj, BadLinesAreNamedByNumber) {
  const Folder folder;
  const std::array<std::array<std::string, 3>, 14> cases = {{
      {"v 1 0 0", "v nan 0 0", "line 2: \"nan\""},
      {"v 1 0 0", "v inf 0 0", "line 2: \"inf\""},
      {"v 1 0 0", "v 1e999 0 0", "line 2: \"1e999\""},
      {"v 1 0 0", "v one 0 0", "line 2: \"one\""},
      {"v 1 0 0", "v 1 0", "line 2: a vertex needs three"},
      {"f 1 3 2", "f 1 3", "line 5: a face has fewer than three"},
      {"f 1 3 2", "f 1 3 0", "line 5: a face uses vertex \"0\""},
      {"f 1 3 2", "f 1 3 77", "line 5: a face uses vertex \"77\", but only 4 exist"},
      {"f 1 3 2", "f 1 3 -5", "line 5: a face uses vertex \"-5\""},
      {"f 1 3 2", "f 1 3 99999999999999999999", "line 5: a face uses vertex"},
      {"f 1 3 2", "f 1 3 2x", "line 5: a face uses vertex \"2x\""},
      {"f 1 3 2", "f 1/1 3/1 2/1", "line 5: a face uses texture coordinate \"1\""},
      {"f 1 3 2", "vt nan 0\nf 1 3 2", "line 5: \"nan\""},
      {"f 1 3 2", std::string("f 1\0 3 2", 8), "line 5: contains binary data"},
  }};
  for (const auto& [good, bad, words] : cases) {
    std::string text = kTetrahedronObj;
    text.replace(text.find(good), good.size(), bad);
    expect_refused(folder.write("a.obj", text), words);
  }
}

TEST(ReadObj, NoFacesAreRefused) {
  const Folder folder;
  expect_refused(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "no faces");
  expect_refused(folder.write("b.obj", "# nothing\n"), "no faces");
}

}  // namespace
}  // namespace hydroprint::mesh
