// The same run from flags and from a spec.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <map>
#include <nlohmann/json.hpp>

#include "hydroprint/v1/report.pb.h"
#include "sim/image/io/image_file.h"
#include "tests/sim/worker/report_file.h"
#include "tests/sim/worker/worker_fixture.h"
#include "tests/support/paths.h"

namespace hydroprint::worker {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// report.json without times, memory and the pose file, because a spec contains its pose.
std::string comparable(const std::string& report) {
  Json json = Json::parse(report);
  Json& run = json["run"];
  for (const char* key : {"stage_seconds", "total_seconds", "peak_memory_bytes"}) run.erase(key);
  Json inputs = Json::array();
  for (const Json& input : run["inputs"]) {
    if (input["role"] != "pose") inputs.push_back(input);
  }
  run["inputs"] = inputs;
  return json.dump(1);
}

class SpecRun : public Worker {
 protected:
  void SetUp() override {
    Worker::SetUp();
    const image::RgbImage film{236, 276, std::vector<std::uint8_t>(3U * 236 * 276, 128)};
    ASSERT_TRUE(image::write_png(path("film.png"), film, 100));
    folder.write("edge.json", "[[-30,-35],[30,-35],[30,35],[-30,35]]");
    folder.write("film.toml", "thickness_mm = 0.25\n");
    folder.write("pose.json",
                 R"({"rotation_wxyz": [0.9, 0.1, 0.3, 0.3], "translation_mm": [1.3, -2, 0]})");
    folder.write("driven.csv", "t_s,x_mm,y_mm,z_mm\n0,0,0,0\n1,0.1,0.2,-5\n6,0,0,-30\n");
  }

  template <class Report = v1::SimulateReport>
  [[nodiscard]] std::map<std::string, std::string> artifacts(const Arguments& arguments) const {
    Arguments command = {testing::program_path("hydroprint-worker")};
    command.insert(command.end(), arguments.begin(), arguments.end());
    command.insert(command.end(), {"--out", out()});
    const Ended ended = testing::run(command);
    EXPECT_EQ(ended.status, 0) << ended.err;
    std::map<std::string, std::string> files;
    for (const std::string& name : names_in(out())) files[name] = content(out() + "/" + name);
    (void)testing::read_message<Report>(out() + "/report.json");
    files["report.json"] = comparable(files["report.json"]);
    fs::remove_all(out());
    return files;
  }

  template <class Report>
  void expect_same(const std::string& verb, Arguments flags, const Json& spec) const {
    SCOPED_TRACE(verb);
    folder.write("spec.json", spec.dump());
    flags.insert(flags.begin(), verb);
    const auto by_flags = artifacts<Report>(flags);
    const auto by_spec = artifacts<Report>({verb, "--spec", path("spec.json")});
    EXPECT_GE(by_flags.size(), 2u);
    for (const auto& [name, bytes] : by_flags) {
      ASSERT_TRUE(by_spec.contains(name)) << name;
      EXPECT_TRUE(by_spec.at(name) == bytes) << name;
    }
    EXPECT_EQ(by_spec.size(), by_flags.size());
    EXPECT_EQ(by_spec.at("report.json"), by_flags.at("report.json"));
  }

  const Json pose_ = {{"rotationWxyz", {0.9, 0.1, 0.3, 0.3}}, {"translationMm", {1.3, -2, 0}}};
};

TEST_F(SpecRun, OfSimulateMakesTheSameArtifactsAsFlags) {
  expect_same<v1::SimulateReport>("simulate",
                                  {"--mesh",
                                   path("sphere.obj"),
                                   "--texture",
                                   path("texture.png"),
                                   "--profile",
                                   path("film.toml"),
                                   "--pose",
                                   path("pose.json"),
                                   "--scale",
                                   "1.1",
                                   "--film",
                                   "polygon:" + path("edge.json"),
                                   "--dpi",
                                   "100",
                                   "--depth-mm",
                                   "9.7",
                                   "--dip-speed-mm-per-s",
                                   "7",
                                   "--threads",
                                   "1"},
                                  {{"mesh", {{"name", "sphere.obj"}, {"asset", "assets/ignored"}}},
                                   {"texture", {{"name", "texture.png"}}},
                                   {"extraFiles", {{{"name", "edge.json"}}}},
                                   {"profile", {{"name", "film.toml"}}},
                                   {"pose", pose_},
                                   {"scale", 1.1},
                                   {"film", "polygon:edge.json"},
                                   {"dpi", 100},
                                   {"depthMm", 9.7},
                                   {"dipSpeedMmPerS", 7},
                                   {"threads", 1}});
  expect_same<v1::SimulateReport>(
      "simulate",
      {"--mesh", path("sphere.obj"), "--film", "60x70", "--model", "stokes", "--artifacts", "map"},
      {{"mesh", {{"name", "sphere.obj"}}},
       {"film", "60x70"},
       {"model", "MODEL_STOKES"},
       {"artifacts", "ARTIFACT_SET_MAP"}});
}

TEST_F(SpecRun, OfPredictMakesTheSameArtifactsAsFlags) {
  expect_same<v1::PredictReport>(
      "predict",
      {"--mesh", path("sphere.obj"), "--film-image", path("film.png"), "--motion",
       path("driven.csv"), "--film", "60x70", "--ink-passes", "0"},
      {{"mesh", {{"name", "sphere.obj"}}},
       {"film_image", {{"name", "film.png"}}},
       {"motion", {{"name", "driven.csv"}}},
       {"film", "60x70"},
       {"ink_passes", 0}});
}

TEST_F(SpecRun, OfPrintImageMakesTheSameArtifactsAsFlags) {
  expect_same<v1::PrintImageReport>("print-image",
                                    {"--film-image",
                                     path("film.png"),
                                     "--film",
                                     "60x70",
                                     "--colours",
                                     "cmyk",
                                     "--ink-limit",
                                     "3",
                                     "--job-name",
                                     "mug 7",
                                     "--date",
                                     "2025-03-14",
                                     "--bar-mm",
                                     "20",
                                     "--printer-margin-mm",
                                     "4",
                                     "--mirror",
                                     "--no-marks",
                                     "--formats",
                                     "pdf,tiff"},
                                    {{"filmImage", {{"name", "film.png"}}},
                                     {"film", "60x70"},
                                     {"colours", "COLOURS_CMYK"},
                                     {"inkLimit", 3},
                                     {"jobName", "mug 7"},
                                     {"date", "2025-03-14"},
                                     {"barMm", 20},
                                     {"printerMarginMm", 4},
                                     {"mirror", true},
                                     {"noMarks", true},
                                     {"formats", {"pdf", "tiff"}}});
}

TEST_F(SpecRun, OfTemplateMakesTheSameArtifactsAsFlags) {
  expect_same<v1::TemplateReport>("template",
                                  {"--mesh", path("sphere.obj"), "--pose", path("pose.json"),
                                   "--film", "60x70", "--paper", "A3", "--job-name", "mug 7"},
                                  {{"mesh", {{"name", "sphere.obj"}}},
                                   {"pose", pose_},
                                   {"film", "60x70"},
                                   {"paper", "A3"},
                                   {"jobName", "mug 7"}});
}

TEST_F(SpecRun, UsesTheInputsFolderAndTheThreadsFlag) {
  fs::create_directory(path("in"));
  fs::rename(path("sphere.obj"), path("in/sphere.obj"));
  folder.write(
      "spec.json",
      R"({"mesh": {"name": "sphere.obj"}, "film": "60x70", "artifacts": 2, "threads": 2})");
  const auto files = artifacts(
      {"simulate", "--spec", path("spec.json"), "--inputs", path("in"), "--threads", "1"});
  const Json report = Json::parse(files.at("report.json"));
  EXPECT_EQ(report["run"]["inputs"][0]["path"], path("in/sphere.obj"));
  EXPECT_EQ(report["run"]["threads"], 1);
}

TEST_F(SpecRun, ReadsStdinToo) {
  folder.write("spec.json", R"({"mesh": {"name": "sphere.obj"}, "film": "60x70", "artifacts": 2})");
  ProcessOptions options;
  const int spec = ::open(path("spec.json").c_str(), O_RDONLY | O_CLOEXEC);
  options.inherited = {{STDIN_FILENO, spec}};
  const Ended ended = testing::run({testing::program_path("hydroprint-worker"), "simulate",
                                    "--spec", "-", "--inputs", folder.path(), "--out", out()},
                                   options);
  ::close(spec);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_TRUE(fs::exists(out() + "/surface_map.ply"));
}

TEST_F(SpecRun, OfPreviewAnswersRequests) {
  folder.write("spec.json", R"({"mesh": {"name": "sphere.obj"}, "film": "60x70", "dpi": 300})");
  folder.write("requests", "{\"id\": 7}\n");
  ProcessOptions options;
  const int requests = ::open(path("requests").c_str(), O_RDONLY | O_CLOEXEC);
  options.inherited = {{STDIN_FILENO, requests}};
  const Ended ended = testing::run(
      {testing::program_path("hydroprint-worker"), "preview", "--spec", path("spec.json")},
      options);
  ::close(requests);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("{\"id\":7,\"depth_mm\":"), std::string::npos);
}

}  // namespace
}  // namespace hydroprint::worker
