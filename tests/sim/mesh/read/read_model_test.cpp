#include <Eigen/Geometry>
#include <limits>
#include <map>
#include <random>

#include "sim/mesh/make_surface.h"
#include "tests/sim/mesh/files.h"
#include "tests/sim/mesh/gltf_files.h"
#include "tests/support/campaign.h"

namespace hydroprint::mesh {
namespace {

void expect_tetrahedron(const Model& m) {
  ASSERT_EQ(m.triangles.size(), 4U);
  for (std::size_t t = 0; t < 4; ++t)
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c)
        EXPECT_EQ(m.vertices[m.triangles[t][k]][c], kCorners[kTetrahedron[t][k]][c]);
}

TEST(ReadModel, EveryFormatGivesTheSameTetrahedron) {
  const Folder folder;
  expect_tetrahedron(read(folder.write("a.obj", kTetrahedronObj)));
  expect_tetrahedron(read(folder.write("a.STL", tetrahedron_stl())));
  expect_tetrahedron(read(folder.write("text.stl", tetrahedron_stl_text())));
  expect_tetrahedron(read(folder.write("text.ply", ply_header("ascii") + kTetrahedronPlyText)));
  expect_tetrahedron(
      read(folder.write("a.ply", ply_header("binary_little_endian") + tetrahedron_ply_body())));
  expect_tetrahedron(read(folder.write("a.gltf", tetrahedron_gltf())));
  expect_tetrahedron(read(folder.write("a.glb", tetrahedron_glb())));
}

TEST(ReadModel, ScaleMultipliesCoordinates) {
  const Folder folder;
  EXPECT_EQ(read(folder.write("a.obj", kTetrahedronObj), 25.4).vertices[1].x(), 25.4);
}

TEST(ReadModel, ScalesOutOfRangeAreRefused) {
  const Folder folder;
  const auto path = folder.write("a.obj", kTetrahedronObj);
  for (const double scale :
       {0.0, -1.0, 1e-6, 1e6, std::nan(""), std::numeric_limits<double>::infinity()}) {
    const auto model = read_model(path, scale, {});
    ASSERT_FALSE(model) << scale;
    EXPECT_EQ(model.error().code, Code::kOutOfRange);
  }
}

TEST(ReadModel, OtherFilesAreRefused) {
  const Folder folder;
  expect_refused(folder.path() / "gone.obj", "no such file", Code::kNotFound);
  expect_refused(folder.write("a.step", "x"), "unknown format");
  expect_refused(folder.write("noending", "x"), "unknown format");
  expect_refused(folder.write("a.obj", ""), "empty");
  std::filesystem::create_directory(folder.path() / "folder.obj");
  expect_refused(folder.path() / "folder.obj", "not a regular file");
}

TEST(ReadModel, ObjectsOfManyKilometresAreRefused) {
  const Folder folder;
  expect_refused(folder.write("a.obj", "v 0 0 0\nv 1e7 0 0\nv 0 1 0\nf 1 2 3\n"), "vertex 1: ");
}

TEST(ReadModel, FacesWithoutAreaAreDroppedWithTheirAttributes) {
  const Folder folder;
  const Model m = read(
      folder.write("a.obj",
                   "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nusemtl a\nf 1/1 2/1 3/1\n"
                   "f 1/1 1/1 4/1\nusemtl b\nf 1/1 2/2 4/1\n"));
  ASSERT_EQ(m.triangles.size(), 1U);
  EXPECT_EQ(m.triangles[0], Eigen::Vector3i(0, 1, 3));
  EXPECT_EQ(m.corner_uvs.at(0)[1], Eigen::Vector2f(1, 0));
  EXPECT_EQ(m.materials[m.triangle_material.at(0)].name, "b");
  ASSERT_TRUE(has_warning(m.warnings, WarningCode::ZERO_AREA_FACES));
  EXPECT_EQ(m.warnings.back().message.substr(0, 7), "2 faces");
}

TEST(ReadModel, OnlyFacesWithoutAreaAreRefused) {
  const Folder folder;
  expect_refused(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n"),
                 "all 2 faces have zero area");
}

TEST(ReadModel, StopsWhenCancelled) {
  const Folder folder;
  Context context;
  context.cancelled = [] { return true; };
  const auto model = read_model(folder.write("a.obj", kTetrahedronObj), 1, context);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, Code::kCancelled);
}

TEST(ReadStl, GivesThreeVerticesPerFacetInTheFilesOrder) {
  const Folder folder;
  for (const auto& bytes : {tetrahedron_stl(), tetrahedron_stl_text()}) {
    const Model m = read(folder.write("a.stl", bytes));
    ASSERT_EQ(m.vertices.size(), 12U);
    for (int t = 0; t < 4; ++t)
      EXPECT_EQ(m.triangles[t], Eigen::Vector3i(3 * t, 3 * t + 1, 3 * t + 2));
    EXPECT_TRUE(make_surface(m, kMaxEdgeMm, {})->closed);
  }
}

TEST(ReadStl, BinaryFilesMayBeginWithSolid) {
  const Folder folder;
  std::string bytes = tetrahedron_stl();
  bytes.replace(0, 6, "solid ");
  expect_tetrahedron(read(folder.write("a.stl", bytes)));
}

TEST(ReadStl, InconsistentTruncatedOrBrokenFilesAreRefused) {
  const Folder folder;
  std::string bytes = tetrahedron_stl();
  const std::uint32_t billions = 4'000'000'000;
  std::memcpy(bytes.data() + 80, &billions, 4);
  expect_refused(folder.write("lie.stl", bytes), "announces 4000000000 facets");
  bytes = tetrahedron_stl();
  expect_refused(folder.write("cut.stl", bytes.substr(0, bytes.size() - 1)), "announces 4 facets");
  expect_refused(folder.write("short.stl", bytes.substr(0, 40)), "too short");
  const float nan = std::nanf("");
  std::memcpy(bytes.data() + 84 + 50 + 20, &nan, 4);
  expect_refused(folder.write("nan.stl", bytes), "facet 1: ");

  const std::string text = tetrahedron_stl_text();
  const auto with = [&](const std::string& good, const std::string& bad) {
    std::string changed = text;
    return folder.write("text.stl", changed.replace(changed.find(good), good.size(), bad));
  };
  expect_refused(with("vertex 0 1 0", "vertex nan 1 0"), "line 5: ");
  expect_refused(with("vertex 0 1 0", "vertex 0 1"), "line 5: ");
  expect_refused(with("vertex 0 1 0\n", ""), "line 7: the facet does not have three corners");
  expect_refused(with("endsolid tetrahedron\n", ""), "ends before");
  expect_refused(folder.write("none.stl", "solid a\nendsolid a\n"), "no facets");
}

TEST(ReadPly, ColoursAndTextureCoordinatesOfVerticesAreKept) {
  const Folder folder;
  const Model m = read(
      folder.write("a.ply",
                   "ply\nformat ascii 1.0\ncomment TextureFile my picture.png\nelement vertex 3\n"
                   "property double x\nproperty double y\nproperty double z\nproperty uchar red\n"
                   "property uchar green\nproperty uchar blue\nproperty float s\nproperty float t\n"
                   "element face 1\nproperty list uchar uint vertex_index\nend_header\n"
                   "0 0 0 255 0 0 0 0\n1 0 0 0 51 0 1 0\n0 1 0 0 0 255 0.5 0.75\n3 0 1 2\n"));
  ASSERT_EQ(m.vertex_colours.size(), 3U);
  EXPECT_EQ(m.vertex_colours[0], Eigen::Vector3f(1, 0, 0));
  EXPECT_NEAR(m.vertex_colours[1].y(), 0.2, 1e-6);
  ASSERT_EQ(m.corner_uvs.size(), 1U);
  EXPECT_EQ(m.corner_uvs[0][2], Eigen::Vector2f(0.5, 0.75));
  EXPECT_EQ(m.materials.at(0).texture, folder.path() / "my picture.png");
}

TEST(ReadPly, InconsistentTruncatedOrBrokenFilesAreRefused) {
  const Folder folder;
  const std::string big = "4000000000";
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const std::string body = format == "ascii" ? kTetrahedronPlyText : tetrahedron_ply_body();
    expect_refused(folder.write("a.ply", ply_header(format, big, "4") + body),
                   "announces 4000000000");
    expect_refused(folder.write("a.ply", ply_header(format, "4", big) + body),
                   "announces 4000000000");
    expect_refused(folder.write("a.ply", ply_header(format, "-4", "4") + body), "header line 4");
    expect_refused(folder.write("a.ply", ply_header(format, "4", "0") + body), "no faces");
  }
  const std::string binary = ply_header("binary_little_endian") + tetrahedron_ply_body();
  expect_refused(folder.write("cut.ply", binary.substr(0, binary.size() - 1)),
                 "face 3: is truncated");
  std::string changed = binary;
  const std::int32_t far = 4;
  std::memcpy(changed.data() + changed.size() - 4, &far, 4);
  expect_refused(folder.write("far.ply", changed), "face 3: uses a vertex out of range");
  changed = binary;
  const float inf = std::numeric_limits<float>::infinity();
  std::memcpy(changed.data() + ply_header("binary_little_endian").size() + 12, &inf, 4);
  expect_refused(folder.write("inf.ply", changed), "vertex 1: ");

  const auto with = [&](const std::string& good, const std::string& bad) {
    std::string text = kTetrahedronPlyText;
    return folder.write("text.ply",
                        ply_header("ascii") + text.replace(text.find(good), good.size(), bad));
  };
  expect_refused(with("1 0 0", "nan 0 0"), "vertex 1: ");
  expect_refused(with("3 0 2 1", "3 0 2"), "face 0: is truncated");
  expect_refused(with("3 0 2 1", "2 0 2"), "face 0: has fewer than three corners");
  expect_refused(with("3 0 2 1", "3 0 2 -1"), "face 0: uses a vertex out of range");
  expect_refused(with("3 2 0 3\n", ""), "face 3: ");
  expect_refused(folder.write("b.ply", "plain text\n"), "does not begin");
  expect_refused(folder.write("b.ply", "ply\nformat ascii 1.0\nelement vertex 3\n"),
                 "has no end_header");
}

TEST(ReadGltf, NodeTransformsAreApplied) {
  const Folder folder;
  const Model m = read(folder.write(
      "a.gltf", tetrahedron_gltf({{"nodes", R"([{"translation":[10,0,0],"children":[1]},
        {"mesh":0,"rotation":[0,0,0.70710678118654757,0.70710678118654757],"scale":[2,2,2]}])"}})));
  ASSERT_EQ(m.vertices.size(), 4U);
  EXPECT_LT((m.vertices[1] - Eigen::Vector3d(10, 2, 0)).norm(), 1e-12);
  EXPECT_LT((m.vertices[3] - Eigen::Vector3d(10, 0, 2)).norm(), 1e-12);
}

TEST(ReadGltf, MirroringNodesKeepFacesFacingOutward) {
  const Folder folder;
  const Model m = read(
      folder.write("a.gltf", tetrahedron_gltf({{"nodes", R"([{"mesh":0,"scale":[-1,1,1]}])"}})));
  const auto surface = make_surface(m, kMaxEdgeMm, {});
  EXPECT_TRUE(surface->closed);
  EXPECT_FALSE(has_warning(surface->warnings, WarningCode::INSIDE_OUT));
}

TEST(ReadGltf, IgnoredSkeletonsAndMorphTargetsGiveWarnings) {
  const Folder folder;
  const Model plain = read(folder.write("a.gltf", tetrahedron_gltf()));
  EXPECT_FALSE(has_warning(plain.warnings, WarningCode::SKIN_IGNORED));
  EXPECT_FALSE(has_warning(plain.warnings, WarningCode::MORPH_IGNORED));
  const Model skinned = read(folder.write(
      "b.gltf", tetrahedron_gltf({{"nodes", R"([{"mesh":0,"skin":0,"children":[1]},{}])"},
                                  {"extra", R"(,"skins":[{"joints":[1]}])"}})));
  EXPECT_TRUE(has_warning(skinned.warnings, WarningCode::SKIN_IGNORED));
  EXPECT_FALSE(has_warning(skinned.warnings, WarningCode::MORPH_IGNORED));
  EXPECT_EQ(skinned.vertices, plain.vertices);
  const Model morphing = read(
      folder.write("c.gltf", tetrahedron_gltf({{"material", R"(,"targets":[{"POSITION":0}])"}})));
  EXPECT_TRUE(has_warning(morphing.warnings, WarningCode::MORPH_IGNORED));
  EXPECT_FALSE(has_warning(morphing.warnings, WarningCode::SKIN_IGNORED));
  EXPECT_EQ(morphing.vertices, plain.vertices);
}

TEST(ReadGltf, MaterialsCoordinatesAndEmbeddedImagesAreKept) {
  const Folder folder;
  const Model m = read(folder.write("a.gltf", textured_gltf()));
  ASSERT_EQ(m.corner_uvs.size(), 4U);
  // In the file, v is 0.25 and points down.
  EXPECT_EQ(m.corner_uvs[1][1], Eigen::Vector2f(1, 0.75));
  const auto& material = m.materials.at(m.triangle_material.at(0));
  EXPECT_TRUE(material.has_colour);
  EXPECT_NEAR(material.colour[0], 1, 1e-6);
  EXPECT_NEAR(material.colour[1], 0.7353569, 1e-5);  // sRGB value of 0.5 in linear light
  EXPECT_EQ(material.wrap_u, Wrap::kClamp);
  EXPECT_EQ(material.wrap_v, Wrap::kMirror);
  ASSERT_EQ(material.texture_bytes.size(), 7U);
  EXPECT_EQ(std::memcmp(material.texture_bytes.data(), "picture", 7), 0);
}

TEST(ReadGltf, BrokenFilesAreRefused) {
  const Folder folder;
  const auto refused = [&](const std::map<std::string, std::string>& parts,
                           const std::string& words) {
    expect_refused(folder.write("a.gltf", tetrahedron_gltf(parts)), words);
  };
  refused({{"nodes", R"([{"mesh":9}])"}}, "mesh 9: does not exist");
  refused({{"nodes", R"([{"mesh":0,"children":[0]}])"}}, "node 0: contains itself");
  refused({{"nodes", R"([{"children":[7]}])"}}, "node 7: does not exist");
  refused({{"count", "4000000000"}}, "positions lie outside");
  refused({{"indexCount", "4000000000"}}, "indices lie outside");
  refused({{"indexCount", "11"}}, "not a multiple of 3");
  refused({{"offset", "100"}}, "positions lie outside");
  refused({{"offset", "18446744073709551615"}}, "");
  refused({{"viewLength", "100000"}}, "positions lie outside");
  refused({{"attribute", "55"}}, "positions lie outside");
  refused({{"index", "300"}}, "uses a vertex out of range");
  refused({{"extra", R"(,"images":[{"bufferView":0,"mimeType":"image/png"}],
      "bufferViews":[{"buffer":0,"byteOffset":900,"byteLength":48}])"}},
          "image 0: ");
  refused({{"extra", R"(,"extensionsRequired":["KHR_draco_mesh_compression"])"}},
          "KHR_draco_mesh_compression");
  refused({{"extra", ",\"extras\":" + std::string(200000, '[') + std::string(200000, ']')}},
          "nested deeper than 64 levels");
  refused({{"uri", "../../../../../../etc/passwd"}}, "");
  const std::string glb = tetrahedron_glb();
  expect_refused(folder.write("a.glb", glb.substr(0, glb.size() - 10)), "announces more bytes");
  expect_refused(folder.write("a.glb", glb.substr(0, 15)), "truncated");
  expect_refused(folder.write("b.gltf", "[1,2,3]"), "not valid glTF JSON");
}

/// Reading a damaged file must end with a model or an error, without invalid memory accesses.
TEST(ReadModel, DamagedFilesAreReadOrRefusedButNeverCrash) {
  const Folder folder;
  const std::map<std::string, std::string> files = {
      {"a.obj", kTetrahedronObj},
      {"a.stl", tetrahedron_stl()},
      {"text.stl", tetrahedron_stl_text()},
      {"text.ply", ply_header("ascii") + kTetrahedronPlyText},
      {"a.ply", ply_header("binary_little_endian") + tetrahedron_ply_body()},
      {"a.gltf", textured_gltf()},
      {"a.glb", tetrahedron_glb()}};
  std::mt19937 random(testing::campaign_seed(20150801));
  for (const auto& [name, bytes] : files) {
    const auto check = [&](const std::string& damaged) {
      const auto model = read_model(folder.write(name, damaged), 1, {});
      if (!model) {
        EXPECT_EQ(model.error().message.find('\n'), std::string::npos);
        return;
      }
      for (const auto& v : model->vertices) EXPECT_TRUE(v.allFinite());
      for (const auto& t : model->triangles) {
        EXPECT_GE(t.minCoeff(), 0);
        EXPECT_LT(t.maxCoeff(), static_cast<int>(model->vertices.size()));
      }
      (void)make_surface(*model, 1e7, {});
    };
    const std::size_t step = std::max<std::size_t>(1, bytes.size() / 80);
    for (std::size_t n = 0; n < bytes.size(); n += step) check(bytes.substr(0, n));
    for (int i = 0; i < testing::campaign_rounds(80); ++i) {
      std::string damaged = bytes;
      for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
      check(damaged);
    }
  }
}

}  // namespace
}  // namespace hydroprint::mesh
