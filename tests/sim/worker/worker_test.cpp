// The program as its users see it: command line in, artifact folder, one line and exit status out.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <unistd.h>

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "sim/image/image_file.h"
#include "tests/sim/worker/bodies.h"
#include "tests/support/process.h"

namespace hydroprint::worker {
namespace {

namespace fs = std::filesystem;
using testing::Ended;
using testing::Process;
using testing::ProcessOptions;
using Arguments = std::vector<std::string>;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

#ifdef __SANITIZE_ADDRESS__
constexpr bool kAddressSpaceIsOurs = false;  // the sanitizer itself maps terabytes
constexpr bool kStderrIsOurs = false;        // its reports must not be lost, nor is libraries' talk
#else
constexpr bool kAddressSpaceIsOurs = true;
constexpr bool kStderrIsOurs = true;
#endif

/// A folder with a small textured sphere, and the program run in it.
class Worker : public ::testing::Test {
 protected:
  void SetUp() override {
    folder.write("sphere.obj", sphere_obj(12, 12));
    image::RgbImage texture{64, 32, std::vector<std::uint8_t>(3 * 64 * 32)};
    for (int y = 0; y < texture.height; ++y) {
      for (int x = 0; x < texture.width; ++x) {
        std::uint8_t* pixel = texture.at(x, y);
        pixel[0] = static_cast<std::uint8_t>(4 * x);
        pixel[1] = static_cast<std::uint8_t>(8 * y);
        pixel[2] = 128;
      }
    }
    ASSERT_TRUE(image::write_png(folder.path() / "texture.png", texture, 100));
  }

  [[nodiscard]] std::string path(const std::string& name) const { return folder.path() / name; }
  [[nodiscard]] std::string out() const { return path("out"); }

  /// simulate on the sphere with a small film, unless the flags say otherwise.
  [[nodiscard]] Arguments simulate(const Arguments& more = {}, bool with_mesh = true) const {
    Arguments all = {
        HYDROPRINT_BIN_DIR "/hydroprint-worker", "simulate", "--out", out(), "--threads", "2"};
    if (with_mesh) all.insert(all.end(), {"--mesh", path("sphere.obj")});
    const auto has = [&](const char* flag) {
      return std::find(more.begin(), more.end(), flag) != more.end();
    };
    if (!has("--film")) all.insert(all.end(), {"--film", "60x70"});
    if (!has("--dpi")) all.insert(all.end(), {"--dpi", "100"});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  /// predict of film.png on the sphere with a small film.
  [[nodiscard]] Arguments predict(const Arguments& more) const {
    Arguments all = {HYDROPRINT_BIN_DIR "/hydroprint-worker",
                     "predict",
                     "--mesh",
                     path("sphere.obj"),
                     "--film-image",
                     path("film.png"),
                     "--film",
                     "60x70",
                     "--out",
                     out()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  /// Runs, and sees to it that it fails as promised: that status, one line that holds all of the
  /// words, nothing on stdout, and a folder as it was before.
  void expect_refusal(int status, const Arguments& command, const Arguments& words,
                      const ProcessOptions& options = {}) const {
    const auto before = names_in(folder.path());
    const Ended ended = testing::run(command, options);
    EXPECT_EQ(ended.status, status) << "signal " << ended.signal << ": " << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_TRUE(ended.err.starts_with("hydroprint-worker: ")) << ended.err;
    for (const std::string& word : words) {
      EXPECT_NE(ended.err.find(word), std::string::npos) << word << " in " << ended.err;
    }
    EXPECT_EQ(ended.out, "");
    EXPECT_EQ(names_in(folder.path()), before);
  }

  testing::TemporaryFolder folder;
};

// ---- What it makes ------------------------------------------------------------------------------

TEST_F(Worker, SimulateMakesTheArtifactsOfTheContract) {
  const Ended ended = testing::run(simulate({"--texture", path("texture.png")}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(names_in(out()),
            (std::set<std::string>{"film.png", "film_map.exr", "predicted.png", "report.json",
                                   "stretch.png", "surface_map.ply", "wrinkles.png"}))
      << "the sphere gathers the film at its top, so there is a picture of that, too";
  EXPECT_NE(ended.out.find(out()), std::string::npos);
  EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"out", "sphere.obj", "texture.png"}));
}

TEST_F(Worker, FilmImageHasTheFilmsSizeAndIsNotJustWhite) {
  ASSERT_EQ(testing::run(simulate({"--texture", path("texture.png"), "--dpi", "254"})).status, 0);
  const auto film = image::read_image(out() + "/film.png", {});
  ASSERT_TRUE(film) << film.error().message;
  EXPECT_EQ(film->image.width, 600);
  EXPECT_EQ(film->image.height, 700);
  const auto& texels = film->image.texels;
  const auto coloured = std::count_if(texels.begin(), texels.end(),
                                      [](const image::Texel& t) { return t.r != 65535; });
  // The lower half of the sphere alone takes a disc of film of at least its own size.
  EXPECT_GT(static_cast<double>(coloured), 3.1 * 120 * 120);
  EXPECT_EQ(texels.front().r, 65535);
}

TEST_F(Worker, MapOnlyMakesTheMapAndTheReport) {
  const Ended ended = testing::run(simulate({"--artifacts", "map"}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(names_in(out()), (std::set<std::string>{"report.json", "surface_map.ply"}));
}

struct Ply {
  std::string header;
  std::vector<std::array<double, 7>> vertices;
  std::vector<std::array<std::int32_t, 3>> faces;
};

Ply read_ply(const fs::path& path) {
  const std::string bytes = content(path);
  const std::string end = "end_header\n";
  std::size_t at = bytes.find(end) + end.size();
  Ply ply{bytes.substr(0, at), {}, {}};
  const auto count = [&](const std::string& what) {
    return std::stoul(ply.header.substr(ply.header.find(what) + what.size()));
  };
  ply.vertices.resize(count("element vertex "));
  ply.faces.resize(count("element face "));
  EXPECT_EQ(bytes.size(), at + 56 * ply.vertices.size() + 13 * ply.faces.size());
  std::memcpy(ply.vertices.data(), bytes.data() + at, 56 * ply.vertices.size());
  at += 56 * ply.vertices.size();
  for (auto& face : ply.faces) {
    EXPECT_EQ(bytes[at], 3);
    std::memcpy(face.data(), bytes.data() + at + 1, 12);
    at += 13;
  }
  return ply;
}

TEST_F(Worker, SurfaceMapHasTheFilesVerticesFirstAndNanWhereNoFilmArrives) {
  const std::string obj = sphere_obj(12, 12);
  ASSERT_EQ(testing::run(simulate({"--artifacts", "map", "--depth-mm", "9"})).status, 0);
  const Ply ply = read_ply(out() + "/surface_map.ply");
  EXPECT_NE(ply.header.find("format binary_little_endian 1.0"), std::string::npos);
  EXPECT_NE(ply.header.find("property double x\nproperty double y\nproperty double z\n"
                            "property double film_x\nproperty double film_y\n"
                            "property double contact_time\nproperty double stretch\n"),
            std::string::npos);
  std::istringstream lines(obj);
  std::size_t index = 0;
  for (std::string word; lines >> word && word == "v"; ++index) {
    Eigen::Vector3d expected;
    lines >> expected.x() >> expected.y() >> expected.z();
    ASSERT_LT(index, ply.vertices.size());
    const auto& vertex = ply.vertices[index];
    EXPECT_NEAR((Eigen::Vector3d(vertex[0], vertex[1], vertex[2]) - expected).norm(), 0, 1e-9)
        << index;
    const bool under_water = expected.z() < -12 + 9 - 0.01;
    const bool above = expected.z() > -12 + 9 + 0.01;
    for (int k = 3; k < 7; ++k) {
      if (above) {
        EXPECT_TRUE(std::isnan(vertex[k])) << index;
      }
      if (under_water) {
        EXPECT_TRUE(std::isfinite(vertex[k])) << index;
      }
    }
    if (under_water) {
      EXPECT_GE(vertex[6], 0.99) << "film is never squeezed both ways";
      EXPECT_NEAR(vertex[5], (expected.z() + 12) / 5, 0.02) << "5 mm/s";
    }
  }
  EXPECT_GT(ply.vertices.size(), index) << "3 mm faces are subdivided";
  for (const auto& face : ply.faces) {
    for (const std::int32_t corner : face) {
      ASSERT_GE(corner, 0);
      ASSERT_LT(static_cast<std::size_t>(corner), ply.vertices.size());
    }
  }
}

TEST_F(Worker, ReportTellsInputsParametersAndFigures) {
  folder.write("pose.json", R"({"rotation_wxyz": [2, 0, 0, 0], "translation_mm": [3, -4, 99]})");
  folder.write("film.toml", "thickness_mm = 0.25\n");
  const Ended ended =
      testing::run(simulate({"--texture", path("texture.png"), "--pose", path("pose.json"),
                             "--profile", path("film.toml"), "--depth-mm", "10", "--json"}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["program"], "hydroprint-worker");
  EXPECT_EQ(report["verb"], "simulate");
  std::map<std::string, nlohmann::json> inputs;
  for (const auto& input : report["inputs"]) inputs[input["role"]] = input;
  for (const std::string role : {"mesh", "texture", "pose", "profile"}) {
    ASSERT_TRUE(inputs.count(role)) << role;
    EXPECT_EQ(inputs[role]["sha256"].get<std::string>().size(), 64u);
    EXPECT_EQ(inputs[role]["size_bytes"], fs::file_size(inputs[role]["path"]));
  }
  const auto& parameters = report["parameters"];
  EXPECT_EQ(parameters["dpi"], 100);
  EXPECT_EQ(parameters["depth_mm"], 10);
  EXPECT_EQ(parameters["model"], "sheet");
  EXPECT_EQ(parameters["profile"]["thickness_mm"], 0.25);
  EXPECT_EQ(parameters["film"]["name"], "60x70");
  EXPECT_EQ(parameters["pose"]["rotation_wxyz"], (std::vector<double>{1, 0, 0, 0}));
  EXPECT_EQ(parameters["pose"]["translation_mm"][0], 3);
  EXPECT_EQ(parameters["pose"]["translation_mm"][1], -4);
  EXPECT_NEAR(parameters["pose"]["translation_mm"][2].get<double>(), 12, 1e-5);
  EXPECT_EQ(report["mesh"]["triangles"], 2 * 24 * 11);
  EXPECT_GT(report["steps"], 5);
  EXPECT_GT(report["peak_memory_bytes"], 1 << 20);
  EXPECT_NEAR(report["depth_mm"].get<double>(), 10, 1e-9);
  EXPECT_NEAR(report["coverage"].get<double>(), 10.0 / 24, 0.05) << "Archimedes' hat box";
  EXPECT_GE(report["stretch"]["max"], report["stretch"]["p95"]);
  EXPECT_GE(report["stretch"]["p95"], report["stretch"]["p50"]);
  double seconds = 0;
  for (const auto& [stage, value] : report["stage_seconds"].items()) seconds += value.get<double>();
  EXPECT_NEAR(seconds, report["total_seconds"].get<double>(), 0.05);
  for (const auto& warning : report["warnings"]) {
    EXPECT_TRUE(warning.contains("code") && warning.contains("message") &&
                warning.contains("where"));
  }
  const auto summary = nlohmann::json::parse(ended.out);
  EXPECT_EQ(summary["out"], out());
  EXPECT_EQ(summary["coverage"], report["coverage"]);
}

TEST_F(Worker, ThreadsDoNotChangeTheArtifacts) {
  const Arguments flags = {"--texture", path("texture.png")};
  std::map<std::string, std::string> first;
  for (const std::string threads : {"1", "2"}) {
    Arguments command = simulate(flags);
    *std::next(std::find(command.begin(), command.end(), "--threads")) = threads;
    const Ended ended = testing::run(command);
    ASSERT_EQ(ended.status, 0) << ended.err;
    for (const std::string& name : names_in(out())) {
      if (name == "report.json") continue;
      const std::string bytes = content(out() + "/" + name);
      if (threads == "1") first[name] = bytes;
      EXPECT_TRUE(first[name] == bytes) << name;
    }
    // Files that tell when they were written would differ.
    if (threads == "1") std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  }
  EXPECT_GE(first.size(), 5U);
}

/// A film image of four colours, one a quarter: red on the right and above, and so on round.
image::RgbImage quarters(int width, int height) {
  image::RgbImage film{width, height, std::vector<std::uint8_t>(3 * width * height)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool right = 2 * x >= width;
      const bool above = 2 * y < height;
      std::uint8_t* pixel = film.at(x, y);
      pixel[0] = right ? 255 : 0;
      pixel[1] = above ? 0 : 255;
      pixel[2] = right ? 0 : 255;
    }
  }
  return film;
}

struct LandedVertex {
  std::array<double, 3> xyz;
  std::array<std::uint8_t, 4> rgb_landed;
};

std::vector<LandedVertex> read_landed(const fs::path& path) {
  const std::string bytes = content(path);
  const std::string vertices = "element vertex ";
  const std::string end = "end_header\n";
  std::size_t at = bytes.find(end) + end.size();
  std::vector<LandedVertex> out(std::stoul(bytes.substr(bytes.find(vertices) + vertices.size())));
  for (LandedVertex& vertex : out) {
    std::memcpy(vertex.xyz.data(), bytes.data() + at, 24);
    std::memcpy(vertex.rgb_landed.data(), bytes.data() + at + 24, 4);
    at += 28;
  }
  return out;
}

TEST_F(Worker, PredictLandsEveryQuarterOfTheFilmOnItsSideOfTheSphere) {
  ASSERT_TRUE(image::write_png(path("film.png"), quarters(240, 280), 100));
  const Ended ended = testing::run(predict({"--depth-mm", "12"}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(names_in(out()),
            (std::set<std::string>{"landed.ply", "landed.png", "predicted.png", "report.json"}));
  int seen = 0;
  for (const auto& [xyz, colour] : read_landed(out() + "/landed.ply")) {
    if (xyz[2] > 0.01) {
      EXPECT_EQ(colour, (std::array<std::uint8_t, 4>{255, 255, 255, 0})) << "above the water";
      continue;
    }
    // Vertices on the borders of the quarters, and where a film of one piece pulls them over,
    // aside.
    if (std::min(std::abs(xyz[0]), std::abs(xyz[1])) < 1.5 || xyz[2] > -0.5) continue;
    const std::array<std::uint8_t, 4> expected = {static_cast<std::uint8_t>(xyz[0] > 0 ? 255 : 0),
                                                  static_cast<std::uint8_t>(xyz[1] > 0 ? 0 : 255),
                                                  static_cast<std::uint8_t>(xyz[0] > 0 ? 0 : 255),
                                                  1};
    EXPECT_EQ(colour, expected) << xyz[0] << " " << xyz[1] << " " << xyz[2];
    ++seen;
  }
  EXPECT_GT(seen, 200);
}

TEST_F(Worker, PredictFollowsThePathAsDriven) {
  ASSERT_TRUE(image::write_png(path("film.png"), quarters(240, 280), 100));
  // The object strays 4 mm to the right on its way down: what lands comes from farther right.
  folder.write("driven.csv", "t_s,x_mm,y_mm,z_mm\n0,0,0,50\n1,4,0,45\n2,4,0,38\n");
  ASSERT_EQ(testing::run(predict({"--depth-mm", "12", "--artifacts", "map"})).status, 0);
  const Ply straight = read_ply(out() + "/surface_map.ply");
  const Ended ended = testing::run(
      predict({"--depth-mm", "12", "--artifacts", "map", "--motion", path("driven.csv")}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  const Ply driven = read_ply(out() + "/surface_map.ply");
  ASSERT_EQ(straight.vertices.size(), driven.vertices.size());
  double shift = 0;
  int count = 0;
  for (std::size_t i = 0; i < driven.vertices.size(); ++i) {
    const double x = driven.vertices[i][3] - straight.vertices[i][3];
    if (!std::isfinite(x) || driven.vertices[i][2] > -2) continue;
    shift += x;
    ++count;
  }
  ASSERT_GT(count, 100);
  EXPECT_GT(shift / count, 0.5);
  EXPECT_LT(shift / count, 4);
}

TEST_F(Worker, PredictRefusesBadFilmImagesAndPaths) {
  folder.write("film.png", "not an image");
  expect_refusal(3, predict({}), {"film.png: "});
  ASSERT_TRUE(image::write_png(path("film.png"), quarters(240, 280), 100));
  folder.write("driven.csv", "t_s,x_mm,y_mm,z_mm\n0,0,0,0\n0,0,0,-1\n");
  expect_refusal(3, predict({"--motion", path("driven.csv")}), {"driven.csv: line 3: "});
}

TEST_F(Worker, AnEarlierRunIsReplacedAndStrangersAreNot) {
  ASSERT_EQ(testing::run(simulate()).status, 0);
  ASSERT_EQ(testing::run(simulate({"--artifacts", "map"})).status, 0);
  EXPECT_EQ(names_in(out()), (std::set<std::string>{"report.json", "surface_map.ply"}));
  std::ofstream(out() + "/notes.txt") << "mine";
  expect_refusal(3, simulate(), {"out: holds notes.txt", "--out"});
  EXPECT_EQ(content(out() + "/notes.txt"), "mine");
}

// ---- Bad input ----------------------------------------------------------------------------------

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

/// The beginning of a PNG that announces a size, with a chunk of data of no use.
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

TEST_F(Worker, ModelsThatLieAboutTheirSizeTakeNoMemory) {
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

  // A texture on the command line answers for all of them.
  const Ended ended = testing::run(
      simulate({"--mesh", path("nomtl.obj"), "--texture", path("texture.png")}, false));
  EXPECT_EQ(ended.status, 0) << ended.err;
}

TEST_F(Worker, ATextureNeedsTextureCoordinates) {
  folder.write("plain.obj",
               "v 0 0 0\nv 10 0 9\nv 0 10 9\nv -10 -10 9\n"
               "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  expect_refusal(3,
                 simulate({"--mesh", path("plain.obj"), "--texture", path("texture.png")}, false),
                 {"plain.obj"});
}

TEST_F(Worker, APoseWhoseFirstContactMissesTheFilmIsRefused) {
  folder.write("pose.json", R"({"translation_mm": [31, 0, 0]})");
  expect_refusal(3, simulate({"--pose", path("pose.json")}), {"film"});
}

TEST_F(Worker, ValuesOutOfRangeAreBadInput) {
  for (const Arguments& flags : {Arguments{"--dpi", "0"},
                                 {"--dpi", "-300"},
                                 {"--dpi", "1e9"},
                                 {"--dpi", "nan"},
                                 {"--film", "5x5"},
                                 {"--film", "3000x200"},
                                 {"--film", "circle:0"},
                                 {"--scale", "0"},
                                 {"--scale", "-1"},
                                 {"--scale", "inf"},
                                 {"--depth-mm", "0"},
                                 {"--depth-mm", "-3"},
                                 {"--dip-speed-mm-per-s", "0"}}) {
    SCOPED_TRACE(flags[1]);
    expect_refusal(3, simulate(flags), {flags[0] + ": "});
  }
  // Each in range, but not together.
  expect_refusal(3, simulate({"--film", "2000x2000", "--dpi", "2400"}), {"dpi"});
}

TEST_F(Worker, BadSmallFilesAreRefusedByNameAndPlace) {
  folder.write("pose.json", R"({"rotation_wxyz": [0, 0, 0, 0]})");
  expect_refusal(3, simulate({"--pose", path("pose.json")}), {"pose.json: rotation_wxyz: "});
  folder.write("film.toml", "\nthick_mm = 1\n");
  expect_refusal(3, simulate({"--profile", path("film.toml")}), {"film.toml: line 2: thick_mm"});
  folder.write("film.json", "[[0,0],[40,40],[40,0],[0,40]]");
  expect_refusal(3, simulate({"--film", std::string("polygon:") + path("film.json")}),
                 {"film.json: "});
  expect_refusal(3, simulate({"--film", std::string("polygon:") + path("no.json")}),
                 {"no.json: no such file"});
}

TEST_F(Worker, AFileBeyondTheLimitIsToldOfAndNothingStays) {
  ProcessOptions limited;
  limited.limits = {{RLIMIT_FSIZE, 20000}};
  expect_refusal(3, simulate({"--texture", path("texture.png")}),
                 {"out", "beyond the limit on file sizes"}, limited);
}

TEST_F(Worker, AFullFileSystemIsToldOfAndNothingStays) {
  const fs::path disk = folder.path() / "disk";
  fs::create_directory(disk);
  if (::mount("none", disk.c_str(), "tmpfs", 0, "size=16k") != 0) GTEST_SKIP() << "needs root";
  Arguments command = simulate({"--texture", path("texture.png")});
  *std::next(std::find(command.begin(), command.end(), "--out")) = disk / "out";
  expect_refusal(3, command, {"disk/out", "disk is full"});
  EXPECT_TRUE(names_in(disk).empty());
  ::umount2(disk.c_str(), MNT_DETACH);
}

TEST_F(Worker, AnOutFolderThatCannotBeMadeIsRefusedFirst) {
  Arguments command = simulate();
  *std::next(std::find(command.begin(), command.end(), "--out")) = path("no/out");
  expect_refusal(3, command, {"no: no such folder", "--out"});
  *std::next(std::find(command.begin(), command.end(), "--out")) = path("sphere.obj");
  expect_refusal(3, command, {"sphere.obj: is a file"});
}

TEST_F(Worker, NamesWithLineEndsStayOnOneLine) {
  expect_refusal(3, simulate({"--mesh", path("two\nlines.obj")}, false), {"two lines.obj"});
}

// ---- Usage --------------------------------------------------------------------------------------

TEST_F(Worker, UsageErrorsEndWithStatusTwo) {
  const std::string worker = HYDROPRINT_BIN_DIR "/hydroprint-worker";
  expect_refusal(2, {worker}, {"--help"});
  expect_refusal(2, {worker, "dance"}, {"--help"});
  expect_refusal(2, {worker, "simulate"}, {"required"});
  expect_refusal(2, {worker, "predict", "--mesh", path("sphere.obj"), "--out", out()},
                 {"--film-image"});
  for (const Arguments& flags : {Arguments{"--nonsense"},
                                 {"--dpi", "many"},
                                 {"--film", "A5"},
                                 {"--film", "circle:big"},
                                 {"--threads", "0"},
                                 {"--threads", "1.5"},
                                 {"--artifacts", "none"},
                                 {"--model", "honey"},
                                 {"--depth-mm", "deep"},
                                 {"--progress-fd", "77"},
                                 {"--ink-passes", "-1"},
                                 {"--film-image", "x.png"}}) {
    SCOPED_TRACE(flags[0]);
    expect_refusal(2, simulate(flags), {flags[0]});
  }
}

// ---- The sheet and its ink
// -----------------------------------------------------------------------

TEST_F(Worker, InkPassesAreReportedWithHowFarTheyMovedTheFilm) {
  ASSERT_EQ(testing::run(
                simulate({"--texture", path("texture.png"), "--ink-passes", "2", "--dpi", "600"}))
                .status,
            0);
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["parameters"]["model"], "sheet");
  EXPECT_EQ(report["parameters"]["ink_passes"], 2);
  const auto& passes = report["ink_passes"];
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_GT(passes[0]["moved_rms_mm"], 0);
  EXPECT_LT(passes[1]["moved_rms_mm"], 0.2 * passes[0]["moved_rms_mm"].get<double>());
}

TEST_F(Worker, InkGivenDirectlyTakesThePlaceOfPasses) {
  ASSERT_EQ(testing::run(simulate({"--ink-image", path("texture.png")})).status, 0);
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["parameters"]["ink_passes"], 0);
  EXPECT_TRUE(report["ink_passes"].empty());
  const auto& inputs = report["inputs"];
  EXPECT_TRUE(std::any_of(inputs.begin(), inputs.end(),
                          [](const auto& input) { return input["role"] == "ink_image"; }));
}

TEST_F(Worker, StokesKnowsNoInkAndSaysThatItKnowsNoDrag) {
  folder.write("film.toml", "drag_length_mm = 5\n");
  ASSERT_EQ(testing::run(simulate({"--model", "stokes", "--profile", path("film.toml")})).status,
            0);
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["parameters"]["model"], "stokes");
  EXPECT_EQ(report["parameters"]["ink_passes"], 0);
  const auto& warnings = report["warnings"];
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(),
                          [](const auto& warning) { return warning["code"] == "drag_ignored"; }));
}

TEST_F(Worker, HelpAndVersionGoToStdout) {
  const std::string worker = HYDROPRINT_BIN_DIR "/hydroprint-worker";
  for (const Arguments& command :
       {Arguments{worker, "--help"}, {worker, "simulate", "--help"}, {worker, "predict", "-h"}}) {
    const Ended ended = testing::run(command);
    EXPECT_EQ(ended.status, 0);
    EXPECT_EQ(ended.err, "");
    EXPECT_NE(ended.out.find("Usage:"), std::string::npos);
  }
  EXPECT_TRUE(testing::run({worker, "--version"}).out.starts_with("hydroprint-worker 0."));
}

TEST_F(Worker, ErrorsAreJsonWhereAsked) {
  const Ended ended = testing::run(simulate({"--mesh", path("no.obj"), "--json"}, false));
  EXPECT_EQ(ended.status, 3);
  const auto error = nlohmann::json::parse(ended.out)["error"];
  EXPECT_EQ(error["code"], "NOT_FOUND");
  EXPECT_EQ(error["exit_status"], 3);
  EXPECT_EQ(std::string("hydroprint-worker: ") + error["message"].get<std::string>() + "\n",
            ended.err);
  const Ended usage = testing::run(simulate({"--dpi", "many", "--json"}));
  EXPECT_EQ(nlohmann::json::parse(usage.out)["error"]["exit_status"], 2);
}

// ---- Progress, cancel, trouble
// --------------------------------------------------------------------

TEST_F(Worker, ProgressOnAPipeRisesToTheEnd) {
  ProcessOptions options;
  options.files = {{5, folder.path() / "progress"}};
  ASSERT_EQ(
      testing::run(simulate({"--progress-fd", "5", "--texture", path("texture.png")}), options)
          .status,
      0);
  std::ifstream lines(path("progress"));
  double last = 0;
  std::set<std::string> stages;
  for (std::string line; std::getline(lines, line);) {
    const auto progress = nlohmann::json::parse(line);
    stages.insert(progress["stage"]);
    EXPECT_GE(progress["fraction"], 0);
    EXPECT_LE(progress["fraction"], 1);
    EXPECT_GE(progress["total_fraction"], last);
    EXPECT_TRUE(progress["eta_s"].is_null() || progress["eta_s"] >= 0);
    last = progress["total_fraction"];
  }
  EXPECT_EQ(last, 1);
  for (const char* stage : {"reading", "waterline", "velocity", "flow map", "film image"}) {
    EXPECT_TRUE(stages.count(stage)) << stage;
  }
}

TEST_F(Worker, AProgressReaderThatGoesAwayOrSleepsChangesNothing) {
  std::array<int, 2> pipe_ends{};
  ASSERT_EQ(::pipe2(pipe_ends.data(), O_CLOEXEC), 0);
  ProcessOptions options;
  options.inherited = {{5, pipe_ends[1]}};
  // Nobody reads; the pipe is full from the start.
  ASSERT_EQ(::fcntl(pipe_ends[1], F_SETPIPE_SZ, 4096), 4096);
  const std::string filling(4096, ' ');
  ASSERT_EQ(::write(pipe_ends[1], filling.data(), filling.size()), 4096);
  EXPECT_EQ(testing::run(simulate({"--progress-fd", "5"}), options).status, 0);
  ::close(pipe_ends[0]);
  const Ended ended = testing::run(simulate({"--progress-fd", "5"}), options);
  EXPECT_EQ(ended.status, 0) << "signal " << ended.signal;
  ::close(pipe_ends[1]);
}

TEST_F(Worker, AClosedStdoutIsNoTrouble) {
  ProcessOptions options;
  options.close_stdout = true;
  const Ended ended = testing::run(simulate({"--json"}), options);
  EXPECT_EQ(ended.status, 0) << ended.err;
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["verb"], "simulate") << "the summary went into no artifact";
}

/// A run that takes long, started and seen at work.
class LongRun : public Worker {
 protected:
  void start() {
    folder.write("big.obj", sphere_obj(60, 300));
    ProcessOptions options;
    options.files = {{5, folder.path() / "progress"}};
    process.emplace(simulate({"--mesh", path("big.obj"), "--film", "A4", "--progress-fd", "5",
                              "--texture", path("texture.png")},
                             false),
                    options);
    while (content(path("progress")).find("velocity") == std::string::npos && process->running()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ASSERT_TRUE(process->running());
  }

  std::optional<Process> process;
};

TEST_F(LongRun, SigtermCancelsAndLeavesNothing) {
  start();
  process->signal(SIGTERM);
  const Ended ended = process->wait();
  EXPECT_EQ(ended.status, 130) << "signal " << ended.signal;
  EXPECT_EQ(ended.err, "hydroprint-worker: cancelled\n");
  EXPECT_EQ(names_in(folder.path()),
            (std::set<std::string>{"big.obj", "progress", "sphere.obj", "texture.png"}));
}

TEST_F(LongRun, SigintCancelsToo) {
  start();
  process->signal(SIGINT);
  EXPECT_EQ(process->wait().status, 130);
}

TEST_F(LongRun, KilledOutrightItLeavesNoFolderOfThatName) {
  start();
  process->signal(SIGKILL);
  EXPECT_EQ(process->wait().signal, SIGKILL);
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Worker, OutOfMemoryIsAnErrorLikeAnother) {
  if (!kAddressSpaceIsOurs) GTEST_SKIP() << "address space cannot be limited";
  folder.write("big.obj", sphere_obj(60, 700));
  ProcessOptions options;
  options.limits = {{RLIMIT_AS, rlim_t{600} << 20}};
  const auto before = names_in(folder.path());
  const Ended ended =
      testing::run(simulate({"--mesh", path("big.obj"), "--film", "A4"}, false), options);
  EXPECT_EQ(ended.status, 4) << "signal " << ended.signal << " " << ended.err;
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_NE(ended.err.find("out of memory"), std::string::npos) << ended.err;
  EXPECT_EQ(names_in(folder.path()), before);
}

}  // namespace
}  // namespace hydroprint::worker
