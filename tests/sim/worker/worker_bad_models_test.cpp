// Invalid models and textures cause a one-line error that names the file, and leave no files.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "tests/sim/worker/worker_fixture.h"

namespace hydroprint::worker {
namespace {

std::string little_endian(std::uint32_t value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string stl(std::uint32_t announced, int facets) {
  std::string bytes(80, ' ');
  bytes += little_endian(announced);
  for (int i = 0; i < facets; ++i) {
    const std::array<float, 12> facet = {0, 0, 1, 0, 0, 0, 10, 0, 0, 0, 10, static_cast<float>(i)};
    bytes.append(reinterpret_cast<const char*>(facet.data()), sizeof facet);
    bytes.append(2, '\0');
  }
  return bytes;
}

std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = ~0u;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1u)));
  }
  return ~crc;
}

std::string big_endian(std::uint32_t value) {
  std::string bytes = little_endian(value);
  std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// The beginning of a PNG whose header states a size, with a chunk of useless data.
std::string png_announcing(std::uint32_t width, std::uint32_t height) {
  const auto chunk = [](const std::string& type, const std::string& data) {
    return big_endian(static_cast<std::uint32_t>(data.size())) + type + data +
           big_endian(crc32(type + data));
  };
  return std::string("\x89PNG\r\n\x1a\n") +
         chunk("IHDR", big_endian(width) + big_endian(height) + std::string("\x08\x02\0\0\0", 5)) +
         chunk("IDAT", "nothing") + chunk("IEND", "");
}

TEST_F(Worker, BadModelsAreRefusedInOneLine) {
  const std::string triangle = "v 0 0 0\nv 10 0 0\nv 0 10 5\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face ";
  const std::string ply_faces =
      "\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n10 0 0\n0 10 5\n";
  const std::vector<std::pair<std::string, std::string>> models = {
      {"truncated.stl", stl(100, 3)},
      {"billions.stl", stl(0xFFFFFFFF, 3)},
      {"short.stl", "solid"},
      {"empty.stl", ""},
      {"none.stl", stl(0, 0)},
      {"billions.ply", ply + "4000000000" + ply_faces + "3 0 1 2\n"},
      {"truncated.ply", ply + "2" + ply_faces + "3 0 1 2\n"},
      {"nan.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
       "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
       "end_header\n0 0 nan\n10 0 0\n0 10 5\n3 0 1 2\n"},
      {"index.ply", ply + "1" + ply_faces + "3 0 1 7\n"},
      {"negative.ply", ply + "1" + ply_faces + "3 0 1 -1\n"},
      {"nan.obj", "v 0 0 nan\nv 10 0 0\nv 0 10 5\nf 1 2 3\n"},
      {"inf.obj", "v 0 0 inf\nv 10 0 0\nv 0 10 5\nf 1 2 3\n"},
      {"index.obj", triangle + "f 1 2 4\n"},
      {"zero.obj", triangle + "f 0 1 2\n"},
      {"negative.obj", triangle + "f -1 -2 -4\n"},
      {"nofaces.obj", triangle},
      {"noarea.obj", "v 0 0 0\nv 10 0 0\nv 20 0 0\nf 1 2 3\n"},
      {"empty.obj", ""},
      {"words.gltf", "not a model"},
      {"words.glb", "not a model"},
      {"model.xyz", "0 0 0\n"},
  };
  for (const auto& [name, bytes] : models) {
    SCOPED_TRACE(name);
    folder.write(name, bytes);
    expect_refusal(3, simulate({"--mesh", path(name)}, false), {name + ": "});
  }
  expect_refusal(3, simulate({"--mesh", path("absent.obj")}, false), {"absent.obj: no such file"});
  expect_refusal(3, simulate({"--mesh", "/dev/zero"}, false), {"/dev/zero: "});
  expect_refusal(3, simulate({"--mesh", folder.path()}, false), {"not a regular file"});
}

TEST_F(Worker, ModelsWithFalseSizesTakeNoMemory) {
  if (!kAddressSpaceIsOurs) GTEST_SKIP() << "address space cannot be limited";
  ProcessOptions little;
  little.limits = {{RLIMIT_AS, rlim_t{1} << 30}};
  folder.write("billions.stl", stl(0xFFFFFFFF, 3));
  expect_refusal(3, simulate({"--mesh", path("billions.stl")}, false), {"billions.stl: "}, little);
  folder.write("huge.png", png_announcing(100000, 100000));
  expect_refusal(3, simulate({"--texture", path("huge.png")}), {"huge.png"}, little);
}

TEST_F(Worker, BadTexturesAreRefusedInOneLine) {
  const std::string png = content(path("texture.png"));
  const std::vector<std::pair<std::string, std::string>> textures = {
      {"huge.png", png_announcing(100000, 100000)},
      {"hollow.png", png_announcing(64, 32)},
      {"truncated.png", png.substr(0, png.size() / 2)},
      {"words.png", "not an image"},
      {"empty.png", ""},
  };
  for (const auto& [name, bytes] : textures) {
    SCOPED_TRACE(name);
    folder.write(name, bytes);
    if (name == "hollow.png" && !kStderrIsOurs) continue;
    expect_refusal(3, simulate({"--texture", path(name)}), {name});
  }
  expect_refusal(3, simulate({"--texture", path("absent.png")}), {"absent.png: no such file"});
}

TEST_F(Worker, MissingPartsOfAModelAreRefusedByName) {
  const std::string tetrahedron =
      "v 0 0 0\nv 10 0 9\nv 0 10 9\nv -10 -10 9\nvt 0 0\nvt 1 0\nvt 0 1\n";
  const std::string faces = "f 1/1 3/2 2/3\nf 1/1 2/2 4/3\nf 1/1 4/2 3/3\nf 2/1 3/2 4/3\n";
  folder.write("nomtl.obj",
               std::string("mtllib absent.mtl\n") + tetrahedron + "usemtl skin\n" + faces);
  expect_refusal(3, simulate({"--mesh", path("nomtl.obj")}, false), {"nomtl.obj: ", "absent.mtl"});
  folder.write("there.mtl", "newmtl other\nKd 1 0 0\n");
  folder.write("nomaterial.obj",
               std::string("mtllib there.mtl\n") + tetrahedron + "usemtl skin\n" + faces);
  expect_refusal(3, simulate({"--mesh", path("nomaterial.obj")}, false), {"skin"});
  folder.write("notexture.mtl", "newmtl skin\nmap_Kd absent skin.png\n");
  folder.write("notexture.obj",
               std::string("mtllib notexture.mtl\n") + tetrahedron + "usemtl skin\n" + faces);
  expect_refusal(3, simulate({"--mesh", path("notexture.obj")}, false), {"absent skin.png"});

  // A texture on the command line replaces all materials and textures of the model.
  const Ended ended = testing::run(
      simulate({"--mesh", path("nomtl.obj"), "--texture", path("texture.png")}, false));
  EXPECT_EQ(ended.status, 0) << ended.err;
}

TEST_F(Worker, UvsAreNotProjectedOntoAModelThatHasNone) {
  folder.write("plain.obj",
               "v 0 0 0\nv 10 0 9\nv 0 10 9\nv -10 -10 9\n"
               "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  expect_refusal(
      3,
      simulate({"--mesh", path("plain.obj"), "--texture", path("texture.png"), "--project", "uv"},
               false),
      {"plain.obj", "no texture coordinates", "projection"});
}

/// A square in the plane z = 0, whose halves have the materials a and b.
std::string square_obj(const std::string& start) {
  return start + "v 0 0 0\nv 20 0 0\nv 20 20 0\nv 0 20 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n";
}

TEST_F(Worker, AModelWithoutColourIsRefusedWithWhatWasFound) {
  folder.write("bare.obj",
               "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  expect_refusal(3, simulate({"--mesh", path("bare.obj")}, false),
                 {"bare.obj", "no colour", "Name a picture", "projection", "paint"});
  folder.write("odd.mtl", "newmtl a\nKd spectral steel.rfl\nnewmtl b\nKe 1 0 0\n");
  folder.write("odd.obj", square_obj("mtllib odd.mtl\n"));
  expect_refusal(
      3, simulate({"--mesh", path("odd.obj")}, false),
      {"odd.obj", "not understood", "material \"a\": Kd spectral", "material \"b\": ke"});
  folder.write("white.mtl", "newmtl a\nKd 1 1 1\nnewmtl b\nKd 1 1 1\n");
  folder.write("white.obj", square_obj("mtllib white.mtl\n"));
  expect_refusal(3, simulate({"--mesh", path("white.obj")}, false), {"white.obj", "no colour"});
}

TEST_F(Worker, ANameThatIsNotUtf8GivesAMessageThatIs) {
  folder.write("latin.mtl", "newmtl a\nmap_Kd Gr\xfcn\x1b[1m.png\nnewmtl b\nKd 1 0 0\n");
  folder.write("latin.obj",
               "mtllib latin.mtl\nv 0 0 0\nv 20 0 0\nv 0 20 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
  expect_refusal(3, simulate({"--mesh", path("latin.obj")}, false),
                 {"latin.obj", "Gr\uFFFDn [1m.png: no such file"});
}

}  // namespace
}  // namespace hydroprint::worker
