// Specs that the program refuses.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/sim/worker/worker_fixture.h"
#include "tests/support/paths.h"

namespace hydroprint::worker {
namespace {

class BadSpec : public Worker {
 protected:
  /// Runs `verb` with a spec.json that has this content.
  [[nodiscard]] Arguments run_of(const std::string& verb, const std::string& json) const {
    folder.write("spec.json", json);
    return {testing::program_path("hydroprint-worker"),
            verb,
            "--spec",
            path("spec.json"),
            "--out",
            out()};
  }
  void expect_bad_spec(const std::string& verb, const std::string& json,
                       const Arguments& words) const {
    SCOPED_TRACE(verb + " " + json);
    Arguments all = {"spec.json: "};
    all.insert(all.end(), words.begin(), words.end());
    expect_refusal(3, run_of(verb, json), all);
  }
};

TEST_F(BadSpec, UnknownFieldsAreRefusedByName) {
  expect_bad_spec("simulate", R"({"mesh": {"name": "sphere.obj"}, "dipi": 300})", {"dipi"});
  expect_bad_spec("simulate", R"({"mesh": {"nam": "sphere.obj"}})", {"nam"});
  expect_bad_spec("validate", R"({"mesh": {"name": "sphere.obj"}})", {"mesh"});
}

TEST_F(BadSpec, ValuesOfTheWrongTypeAreRefusedByField) {
  const std::string mesh = R"({"mesh": {"name": "sphere.obj"}, )";
  expect_bad_spec("simulate", mesh + R"("dpi": "many"})", {"dpi"});
  expect_bad_spec("simulate", mesh + R"("model": "MODEL_HONEY"})", {"model"});
  expect_bad_spec("simulate", mesh + R"("model": 77})", {"model: ", "not a known choice"});
  expect_bad_spec("simulate", mesh + R"("inertia": "perhaps"})", {"inertia"});
  expect_bad_spec("simulate", mesh + R"("pose": {"translationMm": [1, 2]}})",
                  {"pose: translation_mm: "});
  expect_bad_spec("simulate", mesh + R"("pose": {"translationMm": ["NaN", 2, 3]}})", {"pose: "});
}

TEST_F(BadSpec, FieldsThatOnlyADaemonCanResolveAreRefusedByName) {
  const std::string mesh = R"({"mesh": {"name": "sphere.obj"}, )";
  expect_bad_spec("simulate", mesh + R"("calibration": "calibrations/active"})", {"calibration: "});
  expect_bad_spec("simulate", mesh + R"("allowStaleCalibration": true})",
                  {"allow_stale_calibration: "});
  expect_bad_spec("print-image", R"({"simulateJob": "jobs/1"})", {"simulate_job: "});
  expect_bad_spec("template", R"({"simulateJob": "jobs/1"})", {"simulate_job: "});
  expect_bad_spec("calibrate", R"({"captureJob": "jobs/1"})", {"capture_job: "});
  expect_bad_spec("calibrate", R"({"cameraCalibration": "calibrations/1"})",
                  {"camera_calibration: "});
  expect_bad_spec("calibrate-camera", R"({"captureJobs": ["jobs/1"]})", {"capture_jobs: "});
}

TEST_F(BadSpec, MissingFilesAreRefusedByField) {
  expect_bad_spec("simulate", R"({"mesh": {"name": "no.obj"}})",
                  {"mesh: ", "no.obj: no such file"});
  expect_bad_spec("simulate",
                  R"({"mesh": {"name": "sphere.obj"}, "extraFiles": [{"name": "no.mtl"}]})",
                  {"extra_files[0]: ", "no.mtl: no such file"});
  expect_bad_spec("simulate", R"({"mesh": {}})", {"mesh.name: missing"});
  expect_bad_spec("simulate", "{}", {"mesh: missing"});
  expect_bad_spec("predict", R"({"mesh": {"name": "sphere.obj"}})", {"film_image: missing"});
  expect_bad_spec("fit", R"({"mesh": {"name": "sphere.obj"}})", {"points: missing"});
  expect_bad_spec("calibrate-camera", R"({"frames": [{"name": "sphere.obj"}]})",
                  {"frames: ", "frames.json"});
}

TEST_F(BadSpec, ValuesOutOfRangeAreBadInput) {
  const std::string mesh = R"({"mesh": {"name": "sphere.obj"}, )";
  expect_bad_spec("simulate", mesh + R"("dpi": 0})",
                  {"dpi: 0 is out of range. The value must be from 20 to 2400 dots per inch"});
  expect_bad_spec("simulate", mesh + R"("dpi": "NaN"})", {"dpi: "});
  expect_bad_spec("simulate", mesh + R"("inkPasses": 21})", {"ink_passes: 21 is out of range"});
  expect_bad_spec("simulate", mesh + R"("threads": 0})", {"threads: 0 is out of range"});
  for (const char* tolerance : {"0", "0.0049", "-1", "\"NaN\""}) {
    expect_bad_spec("simulate", mesh + "\"toleranceMm\": " + tolerance + "}", {"tolerance_mm: "});
  }
  expect_bad_spec("simulate", mesh + R"("film": "A5"})", {"film: "});
  expect_bad_spec("simulate", mesh + R"("inertia": true, "model": "MODEL_STOKES"})", {"inertia: "});
  expect_bad_spec("fit", R"({"mesh": {"name": "sphere.obj"}, "points": {"name": "sphere.obj"},
                             "free": ["luck"]})",
                  {"free: "});
  expect_bad_spec("validate", R"({"only": ["luck"]})", {"only: "});
  expect_bad_spec("print-image", R"({"filmImage": {"name": "texture.png"}, "formats": ["gif"]})",
                  {"formats: 'gif' is unknown"});
}

TEST_F(BadSpec, TextThatIsNotJsonIsRefused) {
  for (const char* const json : {"", "mesh", "[]", "{\"mesh\": ", "{\"film\": \"\xff\"}"}) {
    expect_bad_spec("simulate", json, {"not a valid SimulateSpec"});
  }
  Arguments command = run_of("simulate", "{}");
  command[3] = path("no.json");
  expect_refusal(3, command, {"no.json: no such file"});
}

TEST_F(BadSpec, FlagsBesideASpecAreBadUsage) {
  for (const Arguments& flags : {Arguments{"--dpi", "300"},
                                 {"--mesh", path("sphere.obj")},
                                 {"--inertia"},
                                 {"--depth-mm", "full"},
                                 {"--pose", path("pose.json")}}) {
    Arguments command = run_of("simulate", "{}");
    command.insert(command.end(), flags.begin(), flags.end());
    expect_refusal(2, command, {flags[0] + ": ", "--spec"});
  }
  expect_refusal(2, simulate({"--inputs", folder.path()}), {"--inputs: ", "--spec"});
  expect_refusal(2, {testing::program_path("hydroprint-worker"), "simulate", "--spec", "x.json"},
                 {"--out"});
}

TEST_F(BadSpec, ErrorsAsJsonNameTheField) {
  Arguments command = run_of("simulate", R"({"mesh": {"name": "sphere.obj"}, "dpi": 1})");
  command.emplace_back("--json");
  const Ended ended = testing::run(command);
  EXPECT_EQ(ended.status, 3);
  const auto error = nlohmann::json::parse(ended.out)["error"];
  EXPECT_EQ(error["code"], "OUT_OF_RANGE");
  EXPECT_EQ(error["field"], "dpi");
}

TEST_F(BadSpec, ATooLargeFilmImageIsNamedByItsField) {
  expect_refusal(
      3,
      run_of("simulate", R"({"mesh": {"name": "sphere.obj"}, "film": "2000x2000", "dpi": 2400})"),
      {"dpi: the film image would have too many pixels"});
}

}  // namespace
}  // namespace hydroprint::worker
