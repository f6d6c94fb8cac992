// The program's output: the artifact folder and the contents of its files.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "sim/image/io/image_file.h"
#include "tests/sim/mesh/gltf_files.h"
#include "tests/sim/worker/artifact_files.h"
#include "tests/sim/worker/bodies.h"
#include "tests/sim/worker/worker_fixture.h"

namespace hydroprint::worker {
namespace {

namespace fs = std::filesystem;

TEST_F(Worker, SimulateWritesTheArtifactsOfTheContract) {
  const Ended ended = testing::run(simulate({"--texture", path("texture.png")}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(names_in(out()), (std::set<std::string>{"error.png", "film.png", "film_map.exr",
                                                    "predicted.png", "report.json", "stretch.png",
                                                    "surface_map.ply", "wrinkles.png"}))
      << "the film gathers at the top of the sphere, so there must be wrinkles.png, too";
  EXPECT_NE(ended.out.find(out()), std::string::npos);
  EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"out", "sphere.obj", "texture.png"}));
}

TEST_F(Worker, AnUncertainPoseIsTheFirstWarningOfASimulation) {
  folder.write("pose.json", R"({"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0],
    "error_p95_mm": 10, "from_nominal_pose": ["shift along x"]})");
  const Ended ended = testing::run(simulate({"--pose", path("pose.json"), "--model", "stokes"}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["run"]["warnings"][0]["code"], "POSE_UNCONSTRAINED");
  EXPECT_NE(ended.err.find("shift along x"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("calibrate again"), std::string::npos) << ended.err;
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
  // The lower half of the sphere alone needs a disc of film of at least its own size.
  EXPECT_GT(static_cast<double>(coloured), 3.1 * 120 * 120);
  EXPECT_EQ(texels.front().r, 65535);
}

TEST_F(Worker, AnEmbeddedPictureIsPrintedAndIsNotASeparateInput) {
  folder.write("body.gltf", mesh::textured_gltf(content(path("texture.png"))));
  const Ended ended = testing::run(
      simulate({"--mesh", path("body.gltf"), "--scale", "20", "--model", "stokes"}, false));
  ASSERT_EQ(ended.status, 0) << ended.err;
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  ASSERT_EQ(report["run"]["inputs"].size(), 1u);
  EXPECT_EQ(report["run"]["inputs"][0]["role"], "mesh");
  const auto film = image::read_image(out() + "/film.png", {});
  ASSERT_TRUE(film) << film.error().message;
  const auto& texels = film->image.texels;
  EXPECT_TRUE(std::any_of(texels.begin(), texels.end(), [](const image::Texel& t) {
    return t.r != t.g || t.g != t.b;
  })) << "the film image must have the colours of the embedded texture";
}

TEST_F(Worker, WithoutColourTheMapAndTheInkOfAnImageAreComputed) {
  folder.write("bare.obj", sphere_obj(12, 12));
  for (const Arguments& more :
       {Arguments{"--artifacts", "map"}, Arguments{"--ink-image", path("texture.png")}}) {
    Arguments all = simulate({"--mesh", path("bare.obj"), "--depth-mm", "4"}, false);
    all.insert(all.end(), more.begin(), more.end());
    const Ended ended = testing::run(all);
    EXPECT_EQ(ended.status, 0) << ended.err;
  }
}

TEST_F(Worker, PartsWithoutColourAreAWarningWithTheirShare) {
  folder.write("parts.mtl", "newmtl red\nKd 1 0 0\n");
  const std::string sphere = sphere_obj(12, 12);
  const auto faces = sphere.find("f ");
  const auto middle = sphere.find("\nf ", (faces + sphere.size()) / 2) + 1;
  folder.write("parts.obj", "mtllib parts.mtl\n" + sphere.substr(0, faces) + "usemtl red\n" +
                                sphere.substr(faces, middle - faces) + "usemtl\n" +
                                sphere.substr(middle));
  const Ended ended =
      testing::run(simulate({"--mesh", path("parts.obj"), "--depth-mm", "4"}, false));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.err.find("of the surface, have no colour at all"), std::string::npos)
      << ended.err;
}

TEST_F(Worker, MapOnlyWritesTheMapAndTheReport) {
  const Ended ended = testing::run(simulate({"--artifacts", "map"}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(names_in(out()), (std::set<std::string>{"report.json", "surface_map.ply"}));
}

TEST_F(Worker, SurfaceMapHasTheFilesVerticesFirstAndNanWhereNoFilmArrives) {
  const std::string obj = sphere_obj(12, 12);
  ASSERT_EQ(testing::run(simulate({"--artifacts", "map", "--depth-mm", "9"})).status, 0);
  const Ply ply = read_ply(out() + "/surface_map.ply");
  EXPECT_NE(ply.header.find("format binary_little_endian 1.0"), std::string::npos);
  EXPECT_NE(ply.header.find("property double x\nproperty double y\nproperty double z\n"
                            "property double film_x\nproperty double film_y\n"
                            "property double contact_time\nproperty double stretch\n"
                            "property double stretch_min\nproperty double error_mm\n"),
            std::string::npos);
  EXPECT_TRUE(ply.header.ends_with(
      "property list uchar int vertex_indices\nproperty uchar flags\nend_header\n"));
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
    for (int k = 3; k < 9; ++k) {
      if (above) {
        EXPECT_TRUE(std::isnan(vertex[k])) << index;
      }
      if (under_water) {
        EXPECT_TRUE(std::isfinite(vertex[k])) << index;
      }
    }
    if (under_water) {
      EXPECT_GE(vertex[6], 0.99) << "film must not be compressed in both directions";
      EXPECT_NEAR(vertex[5], (expected.z() + 12) / 5, 0.02) << "the dip speed is 5 mm/s";
    }
  }
  EXPECT_GT(ply.vertices.size(), index) << "faces of 3 mm must be subdivided";
  std::set<int> all_flags;
  for (std::size_t t = 0; t < ply.faces.size(); ++t) {
    bool is_bare = false;
    for (const std::int32_t corner : ply.faces[t]) {
      ASSERT_GE(corner, 0);
      ASSERT_LT(static_cast<std::size_t>(corner), ply.vertices.size());
      is_bare = is_bare || std::isnan(ply.vertices[corner][3]);
    }
    EXPECT_EQ((ply.flags[t] & 8) != 0, is_bare) << t;
    all_flags.insert(ply.flags[t] & 31);  // the error may have no bound
  }
  EXPECT_EQ(all_flags, (std::set<int>{0, 8, 12}));
}

TEST_F(Worker, ReportHasInputsParametersAndFigures) {
  folder.write("pose.json", R"({"rotation_wxyz": [2, 0, 0, 0], "translation_mm": [3, -4, 99]})");
  folder.write("film.toml", "thickness_mm = 0.25\n");
  const Ended ended =
      testing::run(simulate({"--texture", path("texture.png"), "--pose", path("pose.json"),
                             "--profile", path("film.toml"), "--depth-mm", "10", "--json"}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["run"]["program"], "hydroprint-worker");
  EXPECT_EQ(report["run"]["verb"], "simulate");
  std::map<std::string, nlohmann::json> inputs;
  for (const auto& input : report["run"]["inputs"]) inputs[input["role"]] = input;
  for (const std::string role : {"mesh", "texture", "pose", "profile"}) {
    ASSERT_TRUE(inputs.count(role)) << role;
    EXPECT_EQ(inputs[role]["sha256"].get<std::string>().size(), 64u);
    EXPECT_EQ(inputs[role]["size_bytes"], fs::file_size(inputs[role]["path"]));
  }
  const auto& parameters = report["parameters"];
  EXPECT_EQ(parameters["dpi"], 100);
  EXPECT_EQ(parameters["model"], "MODEL_SHEET");
  const auto& dip = parameters["dip"];
  EXPECT_EQ(dip["depth_mm"], 10);
  EXPECT_EQ(dip["profile"]["thickness_mm"], 0.25);
  EXPECT_EQ(dip["film"]["name"], "60x70");
  EXPECT_EQ(dip["pose"]["rotation_wxyz"], (std::vector<double>{1, 0, 0, 0}));
  EXPECT_EQ(dip["pose"]["translation_mm"][0], 3);
  EXPECT_EQ(dip["pose"]["translation_mm"][1], -4);
  EXPECT_NEAR(dip["pose"]["translation_mm"][2].get<double>(), 12, 1e-5);
  EXPECT_EQ(report["mesh"]["triangles"], 2 * 24 * 11);
  for (const int axis : {0, 1}) {  // the film that lands is around the first contact
    const double contact_mm = axis == 0 ? 3 : -4;
    EXPECT_LT(report["flow"]["film_used_min_mm"][axis], contact_mm - 1);
    EXPECT_GT(report["flow"]["film_used_max_mm"][axis], contact_mm + 1);
  }
  ASSERT_EQ(report["mesh"]["shells"].size(), 1U);
  const auto& shell = report["mesh"]["shells"][0];
  EXPECT_EQ(shell["triangles"], 2 * 24 * 11);
  EXPECT_GT(shell["area_mm2"], 0);
  EXPECT_EQ(shell["closed"], true);
  EXPECT_EQ(shell["rule"], "volume");
  EXPECT_EQ(shell["turned_over"], false);
  EXPECT_GT(report["run"]["peak_memory_bytes"], 1 << 20);
  const auto& flow = report["flow"];
  EXPECT_GT(flow["steps"], 5);
  EXPECT_NEAR(flow["depth_mm"].get<double>(), 10, 1e-9);
  EXPECT_NEAR(flow["coverage"].get<double>(), 10.0 / 24, 0.05)
      << "the wetted share of a sphere equals the immersed share of its height";
  EXPECT_GE(flow["stretch"]["max"], flow["stretch"]["p95"]);
  EXPECT_GE(flow["stretch"]["p95"], flow["stretch"]["p50"]);
  const auto summary = nlohmann::json::parse(ended.out);
  EXPECT_EQ(summary["out"], out());
  EXPECT_EQ(summary["report"], report);
}

// The clock also runs between the last stage and the total. A busy machine may interrupt the
// program there, so the best of several runs counts; a missing stage would be missing in each.
TEST_F(Worker, StageTimesAddUpToTheTotal) {
  double rest_s = HUGE_VAL;
  for (int run = 0; run < 10 && rest_s > 0.05; ++run) {
    ASSERT_EQ(testing::run(simulate({"--artifacts", "map"})).status, 0);
    const auto report = nlohmann::json::parse(content(out() + "/report.json"));
    rest_s = report["run"]["total_seconds"].get<double>();
    for (const auto& stage : report["run"]["stage_seconds"]) rest_s -= stage.get<double>();
    EXPECT_GE(rest_s, -1e-6) << "stages do not overlap";
  }
  EXPECT_LE(rest_s, 0.05);
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
    // Waits, so that files that contain the time of writing would differ.
    if (threads == "1") std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  }
  EXPECT_GE(first.size(), 5U);
}

TEST_F(Worker, EarlierRunsAreReplacedAndForeignFilesAreNot) {
  ASSERT_EQ(testing::run(simulate()).status, 0);
  ASSERT_EQ(testing::run(simulate({"--artifacts", "map"})).status, 0);
  EXPECT_EQ(names_in(out()), (std::set<std::string>{"report.json", "surface_map.ply"}));
  std::ofstream(out() + "/notes.txt") << "mine";
  expect_refusal(3, simulate(), {"out: contains notes.txt", "another folder"});
  EXPECT_EQ(content(out() + "/notes.txt"), "mine");
}

}  // namespace
}  // namespace hydroprint::worker
