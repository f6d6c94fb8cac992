// The verb inspect, which shows how a model is understood.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hydroprint/v1/report.pb.h"
#include "sim/mesh/read/read_model.h"
#include "tests/sim/worker/report_file.h"
#include "tests/sim/worker/worker_fixture.h"
#include "tests/support/paths.h"
#include "tests/support/value_of.h"

namespace hydroprint::worker {
namespace {

class InspectWorker : public Worker {
 protected:
  /// Writes a square of two materials, and the file that defines them.
  void write_square(const std::string& materials) {
    folder.write("square.obj",
                 "mtllib square.mtl\nv 0 0 0\nv 30 0 0\nv 30 20 0\nv 0 20 0\n"
                 "vt 0 0\nvt 1 0\nvt 1 1\nusemtl skin\nf 1/1 2/2 3/3\nusemtl red\nf 1 3 4\n");
    if (!materials.empty()) folder.write("square.mtl", materials);
  }
  [[nodiscard]] Arguments inspect(const Arguments& more = {}) const {
    Arguments all = {testing::program_path("hydroprint-worker"), "inspect", "--out", out()};
    all.insert(all.end(), {"--mesh", path("square.obj")});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

constexpr const char* kMaterials = "newmtl skin\nmap_Kd texture.png\nnewmtl red\nKd 1 0 0\n";

TEST_F(InspectWorker, StatesEachMaterialAndShowsIt) {
  write_square(kMaterials);
  const Ended ended = testing::run(inspect({"--scale", "2"}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  for (const char* words : {"OBJ, 4 vertices, 2 triangles", "size 60 x 40 x 0 mm at scale 2",
                            "material \"skin\", 1 triangles: texture texture.png, 64 x 32 px",
                            "material \"red\", 1 triangles: #ff0000"})
    EXPECT_NE(ended.out.find(words), std::string::npos) << words << " in " << ended.out;
  EXPECT_EQ(names_in(out()), (std::set<std::string>{"model.glb", "report.json"}));

  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report.at("highest_mm"), nlohmann::json({60, 40, 0}));
  EXPECT_EQ(report.at("materials").at(0).at("colour_sources"), nlohmann::json({"TEXTURE"}));
  EXPECT_EQ(report.at("materials").at(1).at("colour_sources"), nlohmann::json({"MATERIAL_COLOUR"}));
  EXPECT_EQ(report.at("shown_triangles"), 2);

  const mesh::Model shown = testing::value_of(mesh::read_model(out() + "/model.glb", 1, {}));
  ASSERT_EQ(shown.triangles.size(), 2U);
  EXPECT_EQ(shown.materials.size(), 2U);
  EXPECT_EQ(shown.vertices[shown.triangles[0][1]], Eigen::Vector3d(60, 0, 0));
}

TEST_F(InspectWorker, JsonHasTheReport) {
  write_square(kMaterials);
  const Ended ended = testing::run(inspect({"--json"}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(nlohmann::json::parse(ended.out).at("report"),
            nlohmann::json::parse(content(out() + "/report.json")));
  (void)testing::read_message<v1::ModelSummary>(out() + "/report.json");
}

TEST_F(InspectWorker, RefusesWithTheWordsOfSimulate) {
  for (const char* materials : {"", "newmtl skin\nmap_Kd absent.png\nnewmtl red\nKd 1 0 0\n"}) {
    write_square(materials);
    Arguments command = simulate({"--mesh", path("square.obj")}, false);
    const Ended simulated = testing::run(command);
    EXPECT_EQ(simulated.status, 3);
    expect_refusal(3, inspect(), {simulated.err});
    const Ended shape = testing::run(inspect({"--shape-only"}));
    EXPECT_EQ(shape.status, 0) << shape.err;
    std::filesystem::remove_all(out());
  }
}

TEST_F(InspectWorker, NamesTheFilesOfItsColoursAndThoseThatAreMissing) {
  using nlohmann::json;
  const auto companions = [this](const Arguments& more) {
    const Ended ended = testing::run(inspect(more));
    EXPECT_EQ(ended.status, 0) << ended.err;
    const auto report = json::parse(content(out() + "/report.json"));
    std::filesystem::remove_all(out());
    return report.at("companions");
  };
  const auto file = [](const char* name, bool is_missing) {
    return json{{"name", name}, {"is_missing", is_missing}};
  };
  write_square(
      "newmtl skin\nmap_Kd Texture.PNG\nnewmtl red\nKd 1 0 0\nnewmtl other\nmap_Kd no.png");
  EXPECT_EQ(companions({}), json({file("square.mtl", false), file("texture.png", false)}));
  write_square("newmtl skin\nmap_Kd maps/absent.png\nnewmtl red\nKd 1 0 0\n");
  EXPECT_EQ(companions({"--shape-only"}),
            json({file("maps/absent.png", true), file("square.mtl", false)}));
  std::filesystem::remove(path("square.mtl"));
  EXPECT_EQ(companions({"--shape-only"}), json({file("square.mtl", true)}));
}

TEST_F(InspectWorker, AModelWithoutColourIsShownInWhite) {
  folder.write("square.obj", "v 0 0 0\nv 30 0 0\nv 30 20 0\nf 1 2 3\n");
  const Ended ended = testing::run(inspect());
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("no colour, stays white"), std::string::npos) << ended.out;
  EXPECT_EQ(nlohmann::json::parse(content(out() + "/report.json")).at("has_colour"), false);
}

TEST_F(InspectWorker, ASmallModelNamesTheLikelyUnit) {
  folder.write("square.obj", "v 0 0 0\nv 0.12 0 0\nv 0.12 0.1 0\nf 1 2 3\n");
  const Ended ended = testing::run(inspect());
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("may be in metres: --scale 1000"), std::string::npos) << ended.out;
}

}  // namespace
}  // namespace hydroprint::worker
