// `hydroprint` as users run it, with the real daemon and a worker controlled by its mesh file.
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/client/late_address.h"
#include "tests/daemon/api/support.h"
#include "tests/hardware/printer/ipp_printer.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace hydroprint::tests {
namespace {

using hydroprint::testing::Process;
using Outcome = hydroprint::testing::Ended;
using Arguments = std::vector<std::string>;
using nlohmann::json;

constexpr double kPatience_s = 120;
const std::string kClient = testing::program_path("hydroprint");

/// Returns a text as one line, with single spaces between words.
std::string flowing(const std::string& text) {
  std::istringstream words(text);
  std::string out;
  for (std::string word; words >> word;) out += (out.empty() ? "" : " ") + word;
  return out;
}

class Cli : public ::testing::Test {
 protected:
  void start(const DaemonProcess::Options& options = DaemonProcess::fake()) {
    daemon_ = std::make_unique<DaemonProcess>(folder_.path(), options);
  }

  Arguments command(const Arguments& arguments) const {
    Arguments all{kClient, "--owner", "tester"};
    if (daemon_) all.insert(all.end(), {"--server", daemon_->address()});
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
  }

  Outcome client(const Arguments& arguments) const {
    return hydroprint::testing::run(command(arguments));
  }

  /// Returns the output of --json. Fails the test unless the exit status is 0 and the output is one
  /// JSON value.
  json client_json(Arguments arguments) const {
    arguments.emplace_back("--json");
    const Outcome ended = client(arguments);
    EXPECT_EQ(ended.status, 0) << ended.err;
    json value = json::parse(ended.out, nullptr, false);
    EXPECT_FALSE(value.is_discarded()) << ended.out;
    return value;
  }

  /// Queues a job whose worker does `work`; returns its name.
  std::string submit(const std::string& work) const {
    return client_json({"submit", "simulate", "--mesh", mesh(work)}).at("name");
  }

  std::string mesh(const std::string& work) const { return folder_.write("m.obj", work).string(); }
  std::filesystem::path out() const { return folder_.path() / "result"; }
  std::string state_of(const std::string& job) const {
    return client_json({"show", job}).at("state");
  }

  /// Starts `watch` for a queued job, lets the job run, and returns the output at its end.
  Outcome watch_whole(const Arguments& flags) const {
    client({"queue", "pause"});
    Arguments arguments{"watch", submit("sleep 5")};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    Process watch(command(arguments));
    EXPECT_TRUE(has_connected(watch));
    client({"queue", "resume"});
    return watch.wait();
  }

  /// Waits until a watch has printed the state of its job; false after kPatience_s.
  static bool has_connected(const Process& watch) {
    return wait_until([&] { return watch.out().ends_with('\n'); }, kPatience_s);
  }

  /// Waits until the job has that state; false after kPatience_s.
  bool becomes(const std::string& job, const std::string& state) const {
    return wait_until([&] { return state_of(job) == state; }, kPatience_s, 0.1);
  }

  /// Expects an error whose last line on stderr contains these words.
  void expect_error(const Arguments& arguments, int status, const std::string& words) const {
    const Outcome ended = client(arguments);
    EXPECT_EQ(ended.status, status) << ended.err;
    const auto line = ended.err.rfind("hydroprint: ");
    ASSERT_NE(line, std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find(words, line), std::string::npos) << ended.err;
    EXPECT_EQ(ended.err.find('\n', line), ended.err.size() - 1) << ended.err;
  }

  TemporaryFolder folder_;
  std::unique_ptr<DaemonProcess> daemon_;
};

TEST_F(Cli, SubmitUploadsTheModelsFilesWaitsAndDownloads) {
  start();
  folder_.write("m.mtl", "map_Kd skin.png\n");
  folder_.write("skin.png", "skin");
  const json job = client_json({"submit", "simulate", "--mesh", mesh("mtllib m.mtl\nsleep 0.2\n"),
                                "--dpi", "120", "--depth-mm", "30", "--out", out().string()});
  EXPECT_EQ(job.at("state"), "SUCCEEDED");
  EXPECT_EQ(job.at("owner"), "tester");
  ASSERT_EQ(job.at("simulate").at("extraFiles").size(), 2U);
  EXPECT_EQ(job["simulate"]["extraFiles"][0]["name"], "m.mtl");
  EXPECT_EQ(job["simulate"]["extraFiles"][1]["name"], "skin.png");
  EXPECT_NE(content(out() / "film.png").find("film of"), std::string::npos);
  const json given = given_spec(content(out() / "report.json"));
  EXPECT_EQ(given.at("dpi"), 120);
  EXPECT_EQ(given.at("depthMm"), 30);
  EXPECT_EQ(job.at("files").size(), 2U);
}

TEST_F(Cli, SubmitPrintsTheJobsNameAndDoesNotWaitByDefault) {
  start();
  const Outcome ended = client({"submit", "simulate", "--mesh", mesh("sleep 30")});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, "jobs/1\n");
}

TEST_F(Cli, ReportsACachedResult) {
  start();
  const std::string path = mesh("sleep 0.1");
  client({"submit", "simulate", "--mesh", path, "--wait"});
  const Outcome ended = client({"submit", "simulate", "--mesh", path, "--wait"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_NE(ended.err.find("cached result of an earlier job"), std::string::npos) << ended.err;
}

TEST_F(Cli, PredictUsesTheFilmImageAndTheMotion) {
  start();
  const json job = client_json({"submit", "predict", "--mesh", mesh("sleep 0.1"), "--film-image",
                                folder_.write("film.png", "film").string(), "--motion",
                                folder_.write("film.csv", "motion").string(), "--wait"});
  EXPECT_EQ(job.at("state"), "SUCCEEDED");
  EXPECT_EQ(job.at("predict").at("filmImage").at("name"), "film.png");
  EXPECT_EQ(job.at("predict").at("motion").at("name"), "film.csv");
}

TEST_F(Cli, InertiaReachesTheWorkerAndIsRefusedWithStokes) {
  start();
  const std::string film = folder_.write("film.png", "film").string();
  for (const std::string verb : {"simulate", "predict"}) {
    Arguments flags{"submit", verb, "--mesh", mesh("sleep 0.1"), "--inertia"};
    if (verb == "predict") flags.insert(flags.end(), {"--film-image", film});
    Arguments stokes = flags;
    stokes.insert(stokes.end(), {"--model", "stokes"});
    expect_error(stokes, 3, "--inertia: ");
    flags.insert(flags.end(), {"--out", out().string()});
    EXPECT_EQ(client_json(flags).at(verb).at("inertia"), true);
    EXPECT_EQ(given_spec(content(out() / "report.json")).at("inertia"), true);
  }
  const json without = client_json({"submit", "simulate", "--mesh", mesh("sleep 0.1")});
  EXPECT_EQ(without.at("simulate").at("inertia"), false);
}

constexpr const char* kTwoDips =
    R"([{"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0], "depth_mm": "full"},
        {"rotation_wxyz": [0, 1, 0, 0], "translation_mm": [0, 2, 0], "depth_mm": 12.5}])";

TEST_F(Cli, PlanSendsTheDipsAndTheFilesOfModelAndFilm) {
  start();
  folder_.write("m.mtl", "map_Kd skin.png\n");
  folder_.write("skin.png", "skin");
  const json job = client_json({"submit", "plan", "--mesh", mesh("mtllib m.mtl"), "--immersions",
                                folder_.write("two.json", kTwoDips).string(), "--film",
                                "polygon:" + folder_.write("film.json", "[[0,0]]").string(),
                                "--profile", folder_.write("film.toml", "").string(), "--scale",
                                "50", "--out", out().string()});
  EXPECT_EQ(job.at("state"), "SUCCEEDED");
  EXPECT_EQ(job.at("displayName"), "plan m.obj");
  for (const json& spec : {job.at("plan"), given_spec(content(out() / "report.json"))}) {
    const json& object = spec.at("object");
    EXPECT_EQ(object.at("mesh").at("name"), "m.obj");
    EXPECT_EQ(object.at("scale"), 50);
    std::vector<std::string> names;
    for (const json& file : object.at("extraFiles")) names.push_back(file.at("name"));
    EXPECT_EQ(names, (std::vector<std::string>{"m.mtl", "skin.png", "film.json"}));
    EXPECT_EQ(spec.at("film").at("film"), "polygon:film.json");
    EXPECT_EQ(spec.at("film").at("profile").at("name"), "film.toml");
    const json& dips = spec.at("immersions");
    ASSERT_EQ(dips.size(), 2U);
    EXPECT_FALSE(dips[0].contains("depthMm"));
    EXPECT_EQ(dips[1].at("depthMm"), 12.5);
    EXPECT_EQ(dips[1].at("pose").at("translationMm"), (json{0, 2, 0}));
  }
}

TEST_F(Cli, BadDipsAreRefusedBeforeAnythingIsUploaded) {
  start();
  const auto plan = [&](const std::string& dips) {
    return Arguments{"submit",        "plan",         "--mesh",
                     mesh("v 0 0 0"), "--immersions", folder_.write("two.json", dips).string()};
  };
  expect_error(plan("[]"), 3, "two.json: no dips");
  expect_error(plan(R"([{"rotation_wxyz": [1, 1, 0, 0], "translation_mm": [0, 0, 0]}])"), 3,
               "two.json: dip 1: rotation_wxyz: the quaternion has length 1.414");
  expect_error({"submit", "plan", "--mesh", mesh("")}, 2, "--immersions");
  EXPECT_TRUE(client_json({"assets"}).at("assets").empty());
}

TEST_F(Cli, APaintIsSentWithItsPicturesEachOnce) {
  start();
  folder_.write("fur.png", "fur");
  const std::string paint = folder_.write("paint.json", R"({"base_colour": "#102030", "layers": [
      {"picture": "fur.png", "projection": "box", "size_mm": 40},
      {"picture": {"name": "fur.png"}, "projection": "decal", "name": "eyes"}]})");
  const json job = client_json(
      {"submit", "simulate", "--mesh", mesh("v 0 0 0"), "--paint", paint, "--out", out().string()});
  EXPECT_EQ(job.at("state"), "SUCCEEDED");
  for (const json& spec : {job.at("simulate"), given_spec(content(out() / "report.json"))}) {
    EXPECT_EQ(spec.at("paint").at("baseColour"), "#102030");
    const json& layers = spec.at("paint").at("layers");
    ASSERT_EQ(layers.size(), 2U);
    EXPECT_EQ(layers[0].at("picture").at("name"), "fur.png");
    EXPECT_EQ(layers[0].at("picture"), layers[1].at("picture"));
    EXPECT_EQ(layers[0].at("sizeMm"), 40);
    EXPECT_EQ(layers[1].at("name"), "eyes");
  }
  const json short_form = client_json({"submit", "simulate", "--mesh", mesh("v 0 0 0"), "--texture",
                                       (folder_.path() / "fur.png").string(), "--project", "dip",
                                       "--project-turn-deg", "90"});
  EXPECT_EQ(short_form.at("simulate").at("project"), "dip");
  EXPECT_EQ(short_form.at("simulate").at("projectTurnDeg"), 90);
}

TEST_F(Cli, BadPaintsAreRefusedBeforeAnythingIsUploaded) {
  start();
  const auto simulate = [&](const std::string& paint) {
    return Arguments{"submit",        "simulate", "--mesh",
                     mesh("v 0 0 0"), "--paint",  folder_.write("paint.json", paint).string()};
  };
  expect_error(simulate("{"), 3, "paint.json");
  expect_error(simulate(R"({"layers": [{"picture": "absent.png"}]})"), 3,
               "absent.png: no such file");
  expect_error(simulate(R"({"layers": [{"colour": "#000000", "projection": "decal",
                            "direction": [0, 0, 0]}]})"),
               3, "paint.json: layers[0].direction: has no length");
  EXPECT_TRUE(client_json({"assets"}).at("assets").empty());
}

TEST_F(Cli, FitUsesTheMeasuredPoints) {
  start();
  const json job =
      client_json({"submit", "fit", "--mesh", mesh("sleep 0.1"), "--points",
                   folder_.write("measured.csv", "points").string(), "--free", "drag,swelling",
                   "--drop-outliers", "--depth-mm", "30", "--out", out().string()});
  EXPECT_EQ(job.at("state"), "SUCCEEDED");
  const json& spec = job.at("fit");
  EXPECT_EQ(spec.at("points").at("name"), "measured.csv");
  EXPECT_EQ(spec.at("free"), (json{"drag", "swelling"}));
  EXPECT_EQ(spec.at("dropOutliers"), true);
  const json given = given_spec(content(out() / "report.json"));
  EXPECT_EQ(given.at("points").at("name"), "measured.csv");
  EXPECT_EQ(given.at("free"), (json{"drag", "swelling"}));
  EXPECT_EQ(given.at("dropOutliers"), true);
  const Outcome ended = client({"submit", "fit", "--mesh", mesh("sleep 0.1")});
  EXPECT_EQ(ended.status, 2);
  EXPECT_NE(ended.err.find("--points"), std::string::npos) << ended.err;
}

TEST_F(Cli, ValidateNeedsNoFiles) {
  start();
  const json job = client_json({"submit", "validate", "--only", "repeatability,bowl", "--quick",
                                "--threads", "2", "--out", out().string()});
  EXPECT_EQ(job.at("state"), "SUCCEEDED");
  EXPECT_EQ(job.at("validate"),
            (json{{"only", {"repeatability", "bowl"}}, {"quick", true}, {"threads", 2}}));
  EXPECT_FALSE(job.contains("mesh"));
  const json given = given_spec(content(out() / "report.json"));
  EXPECT_EQ(given.at("only"), (json{"repeatability", "bowl"}));
  EXPECT_EQ(given.at("quick"), true);
}

TEST_F(Cli, PrintImageUsesTheFilmImageAndThePaper) {
  start();
  const json job =
      client_json({"submit", "print-image", "--film-image", folder_.write("film.png", "film"),
                   "--icc-profile", folder_.write("p.icc", "profile"), "--paper", "A3",
                   "--job-name", "mug 7", "--formats", "pdf,tiff", "--out", out().string()});
  EXPECT_EQ(job.at("state"), "SUCCEEDED");
  const json& spec = job.at("printImage");
  EXPECT_EQ(spec.at("filmImage").at("name"), "film.png");
  EXPECT_EQ(spec.at("iccProfile").at("name"), "p.icc");
  EXPECT_EQ(spec.at("formats"), (json{"pdf", "tiff"}));
  EXPECT_FALSE(spec.contains("mesh"));
  const json given = given_spec(content(out() / "spec.json"));
  EXPECT_EQ(given.at("paper"), "A3");
  EXPECT_EQ(given.at("jobName"), "mug 7");
}

TEST_F(Cli, FilesWithTheSameNameAreKeptApartInAJob) {
  start();
  std::filesystem::create_directory(folder_.path() / "other");
  folder_.write("m.mtl", "map_Kd skin.png\n");
  folder_.write("skin.png", "one");
  const std::string texture = folder_.write("other/skin.png", "two").string();
  const json job = client_json(
      {"submit", "simulate", "--mesh", mesh("mtllib m.mtl"), "--texture", texture, "--wait"});
  EXPECT_EQ(job.at("simulate").at("texture").at("name"), "2-skin.png");
  EXPECT_EQ(job.at("state"), "SUCCEEDED");
}

TEST_F(Cli, EveryVerbPrintsJson) {
  start();
  const std::string job = submit("sleep 0.1");
  ASSERT_TRUE(becomes(job, "SUCCEEDED"));
  EXPECT_EQ(client_json({"status"}).at("health"), "SERVING");
  EXPECT_EQ(client_json({"list"}).at("jobs").at(0).at("name"), job);
  EXPECT_EQ(client_json({"list", "--state", "failed"}).at("jobs").size(), 0U);
  EXPECT_EQ(client_json({"artifacts", job}).at("artifacts").size(), 2U);
  EXPECT_EQ(client_json({"artifacts", job}).at("artifacts").at(0).at("name"),
            job + "/artifacts/film.png");
  EXPECT_EQ(client_json({"events", job}).at("events").at(0).at("state"), "QUEUED");
  EXPECT_EQ(client_json({"queue", "show"}).at("paused"), false);
  EXPECT_EQ(client_json({"upload", mesh("x")}).at("assets").size(), 1U);
  EXPECT_EQ(client_json({"assets", "list"}).at("assets").size(), 2U);
  const std::string again = client_json({"retry", job}).at("name");
  EXPECT_NE(again, job);
  ASSERT_TRUE(becomes(again, "SUCCEEDED"));
  EXPECT_EQ(client_json({"show", again}).at("retryOf"), job);
  EXPECT_EQ(client_json({"delete", job}).at("deleted").at(0), job);
  expect_error({"show", job}, 3, job);
}

TEST_F(Cli, WatchPrintsALineOfJsonForEachEvent) {
  start();
  const Outcome ended = watch_whole({"--json"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  std::istringstream lines(ended.out);
  json last;
  double progress_fraction = 0;
  for (std::string line; std::getline(lines, line);) {
    last = json::parse(line, nullptr, false);
    ASSERT_TRUE(last.is_object()) << line;
    if (last.contains("event"))
      progress_fraction = std::max<double>(progress_fraction, last["event"].at("progressFraction"));
  }
  EXPECT_EQ(last.at("job").at("state"), "SUCCEEDED");
  EXPECT_GT(progress_fraction, 0);
}

TEST_F(Cli, WatchPrintsLinesWithTheTimeLeftWithoutATerminal) {
  start();
  const Outcome ended = watch_whole({});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find(" left\n"), std::string::npos) << ended.out;
  EXPECT_EQ(ended.out.find('\r'), std::string::npos) << ended.out;
}

TEST_F(Cli, ExitStatusDistinguishesBadInputFromFailure) {
  start();
  expect_error({"submit", "simulate", "--mesh", mesh("exit 3 m.obj:7: not a number; fix it"),
                "--out", out().string()},
               3, "m.obj:7: not a number; fix it");
  EXPECT_FALSE(std::filesystem::exists(out()));
  expect_error({"watch", submit("exit 4 it diverged")}, 4, "it diverged");
  expect_error({"show", "77"}, 3, "jobs/77");
  expect_error({"show", "nonsense"}, 3, "nonsense");
  expect_error({"submit", "simulate", "--mesh", "/no/such.obj"}, 3, "/no/such.obj");
  expect_error({"submit", "simulate", "--mesh", mesh(""), "--dpi", "1e9"}, 3, "dpi");
  expect_error({"submit", "simulate", "--mesh", mesh(""), "--dpi", "many"}, 2, "--dpi");
  expect_error({"submit", "simulate"}, 2, "--mesh");
  expect_error({"frobnicate"}, 2, "unknown command 'frobnicate'; see hydroprint --help");
}

TEST_F(Cli, SuggestsTheNearestCommandOrFlag) {
  expect_error({"sumbit"}, 2, "unknown command 'sumbit'; did you mean 'submit'? See hydroprint ");
  expect_error({"queue", "pasue"}, 2, "did you mean 'pause'? See hydroprint queue --help");
  expect_error({"submit", "simulate", "--mseh=m.obj"}, 2,
               "unknown flag '--mseh'; did you mean '--mesh'?");
  expect_error({"list", "--jsn"}, 2, "did you mean '--json'? See hydroprint list --help");
  expect_error({"list", "--zzzzzz"}, 2, "unknown flag '--zzzzzz'; see hydroprint list --help");
}

TEST_F(Cli, WithoutACommandItPrintsTheHelp) {
  const Outcome bare = hydroprint::testing::run({kClient});
  EXPECT_EQ(bare.status, 2);
  EXPECT_NE(bare.err.find("hydroprint submit simulate"), std::string::npos) << bare.err;
  const Outcome help = hydroprint::testing::run({kClient, "help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.out, bare.err);
  EXPECT_EQ(hydroprint::testing::run({kClient, "help", "rig", "move"}).out,
            hydroprint::testing::run({kClient, "rig", "move", "--help"}).out);
  expect_error({"help", "nothing"}, 3, "unknown command 'nothing'");
}

TEST_F(Cli, CommandsWithoutAVerbShowTheirState) {
  start();
  EXPECT_EQ(client_json({"queue", "pause"}).at("paused"), true);
  const std::string job = submit("sleep 0.1");
  EXPECT_EQ(client({"queue"}).out, "paused: \nrunning:\nqueued:  " + job + "\n");
  EXPECT_EQ(client({"rig"}).out, client({"rig", "status"}).out);
  EXPECT_EQ(client_json({"assets"}).at("assets").size(), 1U);
}

TEST_F(Cli, ListShowsTheJobsOfAnOwner) {
  start();
  const std::string job = submit("sleep 0.1");
  EXPECT_EQ(client_json({"list", "--owner", "tester"}).at("jobs").at(0).at("name"), job);
  EXPECT_TRUE(client_json({"list", "--owner", "alice"}).at("jobs").empty());
}

TEST_F(Cli, ValidateOnlyRefusesWhatTheWorkerWouldRefuse) {
  start();
  const auto validate = [&](Arguments flags) {
    flags.insert(flags.begin(),
                 {"submit", "simulate", "--mesh", mesh(""), "--validate-only", "--film"});
    return client(flags);
  };
  EXPECT_EQ(validate({"A3"}).status, 0);
  const Outcome ended = validate({"A9"});
  EXPECT_EQ(ended.status, 3);
  EXPECT_NE(ended.err.find("--film: film 'A9' is not a known size or shape"), std::string::npos)
      << ended.err;
}

TEST_F(Cli, EachWrongFieldHasItsOwnLine) {
  start();
  const Outcome ended = client({"submit", "print-image", "--film-image", mesh(""), "--paper", "A9",
                                "--bar-mm", "-1", "--formats", "pdf,svg"});
  EXPECT_EQ(ended.status, 3);
  EXPECT_EQ(ended.err,
            "hydroprint: the request has several wrong fields:\n"
            "  --paper: paper 'A9': unknown size. Use A4, A3, letter or WIDTHxHEIGHT "
            "(mm)\n"
            "  --bar-mm: must be from 0 to 2000 mm\n"
            "  --formats: must be pdf, png or tiff, not \"svg\"\n");
}

TEST_F(Cli, HelpShowsRangesAndDefaults) {
  const auto help = [&](const Arguments& command) { return client(command).out; };
  const std::string simulate = help({"submit", "simulate", "--help"});
  for (const char* words : {"from 20 to 2400 dots per inch; default 300", "default A4",
                            "sheet, stokes; default sheet", "from 1 to 256"}) {
    EXPECT_NE(flowing(simulate).find(words), std::string::npos) << words << "\n" << simulate;
  }
  EXPECT_NE(flowing(help({"dip", "--help"})).find("from 0 to 600 s; default 2"), std::string::npos);
  EXPECT_NE(flowing(help({"capture", "--help"})).find("from 0.1 to 20 s; default 2"),
            std::string::npos);
}

TEST_F(Cli, NamesTheAddressWhereNoDaemonResponds) {
  expect_error({"--server", "nonsense", "status"}, 2, "nonsense");
  expect_error({"--server", "127.0.0.1:1", "list"}, 5, "127.0.0.1:1");
  expect_error({"--server", "127.0.0.1:1", "watch", "1"}, 5, "127.0.0.1:1");
  const Outcome ended = client({"--server", "127.0.0.1:1", "status", "--json"});
  EXPECT_EQ(json::parse(ended.out, nullptr, false).at("error").at("code"), "UNAVAILABLE");
}

TEST_F(Cli, ConnectsToADaemonThatStartsAMomentLater) {
  start();
  const auto run_early = [&](const Arguments& arguments) {
    const LateAddress address(daemon_->address());
    Arguments all{kClient, "--server", address.text()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome ended = hydroprint::testing::run(all);
    EXPECT_TRUE(address.has_refused());
    return ended;
  };
  const Outcome ended = run_early({"status"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const Outcome watched = run_early({"watch", "jobs/1"});
  EXPECT_NE(watched.err.find("jobs/1"), std::string::npos) << "answered: " << watched.err;
}

TEST_F(Cli, CtrlCWhileWaitingLeavesTheJobRunning) {
  start();
  const std::string job = submit("sleep 600");
  Process watch(command({"watch", job}));
  ASSERT_TRUE(becomes(job, "RUNNING"));
  ASSERT_TRUE(has_connected(watch));
  watch.signal(SIGINT);
  const Outcome ended = watch.wait();
  EXPECT_EQ(ended.status, 130) << ended.err;
  EXPECT_NE(ended.err.find("hydroprint cancel " + job), std::string::npos) << ended.err;
  EXPECT_EQ(state_of(job), "RUNNING");
}

TEST_F(Cli, CtrlCCancelsTheJobOnRequest) {
  start();
  const std::string job = submit("sleep 600");
  Process watch(command({"watch", job, "--cancel-on-interrupt"}));
  ASSERT_TRUE(becomes(job, "RUNNING"));
  ASSERT_TRUE(has_connected(watch));
  watch.signal(SIGINT);
  EXPECT_EQ(watch.wait().status, 130);
  EXPECT_TRUE(becomes(job, "CANCELLED"));
}

TEST_F(Cli, WatchingACancelledJobExitsWith130) {
  start();
  const std::string job = submit("sleep 600");
  Process watch(command({"watch", job}));
  ASSERT_TRUE(becomes(job, "RUNNING"));
  EXPECT_EQ(client({"cancel", job}).status, 0);
  EXPECT_EQ(watch.wait().status, 130);
}

TEST_F(Cli, QueuePausesReordersAndResumes) {
  start();
  EXPECT_EQ(client_json({"queue", "pause", "--reason", "new film"}).at("paused"), true);
  const std::string first = submit("sleep 0.1");
  const std::string second = submit("sleep 0.2");
  EXPECT_EQ(client({"queue", "move", second, "--before", first}).status, 0);
  const json queue = client_json({"queue", "show"});
  EXPECT_EQ(queue.at("pauseReason"), "new film");
  EXPECT_EQ(queue.at("queuedJobs"), json({second, first}));
  EXPECT_EQ(client_json({"queue", "resume"}).at("paused"), false);
  EXPECT_TRUE(becomes(first, "SUCCEEDED"));
}

// The cluster's shared folder is not mounted.
TEST_F(Cli, QueueAndStatusSayWhyNoJobStarts) {
  const auto programs = folder_.path() / "bin", shared = folder_.path() / "shared";
  std::filesystem::create_directories(programs);
  std::filesystem::create_directories(shared);
  for (const char* name : {"sbatch", "squeue", "scancel"}) {
    std::filesystem::permissions(folder_.write(std::string("bin/") + name, "#!/bin/sh\n"),
                                 std::filesystem::perms::owner_all);
  }
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", (programs.string() + ":" + path).c_str(), 1);
  DaemonProcess::Options options = DaemonProcess::fake();
  options.workers = "executor = \"slurm\"\n[workers.slurm]\nfolder = \"" + shared.string() + "\"\n";
  start(options);
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(client_json({"queue"}).at("blockedReason"), "");

  std::filesystem::rename(shared, folder_.path() / "elsewhere");
  const std::string job = submit("sleep 0.1");
  EXPECT_TRUE(wait_until([&] { return client_json({"queue"}).at("blockedReason") != ""; }));
  EXPECT_EQ(state_of(job), "QUEUED");
  const std::string words = "no job starts: " + (shared / "default").string() + " (workers.slurm.";
  for (const char* verb : {"queue", "status"}) {
    const std::string said = client({verb}).out;
    EXPECT_NE(said.find(words), std::string::npos) << said;
  }
}

class CliDownload : public Cli {
 protected:
  CliDownload() {
    start();
    job_ = submit("sleep 0.1");
    EXPECT_TRUE(becomes(job_, "SUCCEEDED"));
    const json artifact = client_json({"artifacts", job_}).at("artifacts").at(0);
    sha256_ = artifact.at("sha256");
    part_ = out() / (".film.png." + sha256_.substr(0, 16) + ".part");
    std::filesystem::create_directory(out());
  }
  Outcome download() const {
    return client({"download", job_, "film.png", "--out", out().string()});
  }
  std::string sha256_of_film() const { return hash_of(content(out() / "film.png")); }

  std::string job_;
  std::string sha256_;
  std::filesystem::path part_;
};

TEST_F(CliDownload, ReplacesAFileWithOtherBytesAndLeavesNoPartFile) {
  std::ofstream(out() / "film.png") << "something else";
  EXPECT_EQ(download().status, 0);
  EXPECT_EQ(sha256_of_film(), sha256_);
  EXPECT_FALSE(std::filesystem::exists(part_));
}

TEST_F(CliDownload, ResumesWhereItStopped) {
  std::ofstream(part_) << "film o";
  EXPECT_EQ(download().status, 0);
  EXPECT_EQ(sha256_of_film(), sha256_);
}

TEST_F(CliDownload, NeverCreatesAFileWithWrongBytes) {
  std::ofstream(part_) << "FILM";
  const Outcome ended = download();
  EXPECT_EQ(ended.status, 4) << "a damaged download is not an input error";
  EXPECT_NE(ended.err.find("SHA-256"), std::string::npos) << ended.err;
  EXPECT_FALSE(std::filesystem::exists(out() / "film.png"));
  EXPECT_EQ(download().status, 0) << "a second attempt starts over";
  EXPECT_EQ(sha256_of_film(), sha256_);
}

TEST_F(CliDownload, ListsTheArtifactsIfTheNameIsUnknown) {
  expect_error({"download", job_, "nope.png"}, 3, "film.png");
}

TEST_F(CliDownload, ADashPrintsOneArtifact) {
  const Outcome printed = client({"download", job_, "film.png", "--out", "-"});
  EXPECT_EQ(printed.status, 0) << printed.err;
  EXPECT_EQ(hash_of(printed.out), sha256_);
  expect_error({"download", job_, "--out", "-"}, 3, "specify its name");
}

TEST_F(CliDownload, NamesAFolderThatCannotBeCreated) {
  const std::string file = folder_.write("file", "").string();
  expect_error({"download", job_, "--out", file + "/below"}, 3, file);
}

TEST_F(Cli, CompletionScriptsAreValidAndComplete) {
  const std::string bash = folder_.write("c.bash", client({"completion", "bash"}).out).string();
  EXPECT_EQ(hydroprint::testing::run({"/bin/bash", "-n", bash}).status, 0);
  const auto complete = [&](const std::string& words, int at) {
    const std::string script = "source " + bash + "; COMP_WORDS=(hydroprint " + words +
                               "); COMP_CWORD=" + std::to_string(at) +
                               "; _hydroprint; echo \"${COMPREPLY[*]}\"";
    return hydroprint::testing::run({"/bin/bash", "-c", script}).out;
  };
  EXPECT_EQ(complete("wat", 1), "watch\n");
  EXPECT_EQ(complete("submit simulate --mod", 3), "--model\n");
  EXPECT_EQ(complete("submit predict --ine", 3), "--inertia\n");
  EXPECT_EQ(complete("submit plan --imm", 3), "--immersions\n");
  EXPECT_EQ(complete("submit plan --model st", 4), "stokes\n");
  EXPECT_EQ(complete("--owner me submit simulate --model st", 6), "stokes\n");
  EXPECT_EQ(complete("queue pa", 2), "pause\n");
  EXPECT_EQ(complete("rig lease acq", 3), "acquire\n");
  EXPECT_EQ(complete("rig move 10 --sp", 4), "--speed\n");
  EXPECT_EQ(complete("dip --simu", 2), "--simulate-job\n");
  EXPECT_EQ(complete("confirm 7 LAY", 3), "LAY_FILM\n");
  EXPECT_EQ(complete("plan ne", 2), "next\n");
  EXPECT_EQ(complete("plan next 7 --imm", 4), "--immersion\n");
  for (const char* shell : {"zsh", "fish"}) {
    const Outcome ended = client({"completion", shell});
    EXPECT_EQ(ended.status, 0);
    EXPECT_NE(ended.out.find("submit simulate"), std::string::npos);
  }
}

TEST_F(Cli, PythonExampleFetchesTheFilm) {
  start();
  const Outcome ended = hydroprint::testing::run(
      {"/usr/bin/env", "PYTHONPATH=" + testing::build_path("python"), "PYTHONDONTWRITEBYTECODE=1",
       "/usr/bin/python3", testing::source_path("client/python/submit_and_fetch.py"), "--server",
       daemon_->address(), "--mesh", mesh("sleep 0.2"), "--out", out().string()});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(content(out() / "film.png").find("film of"), std::string::npos);
}

TEST_F(Cli, SampleRefusesAnUnknownKind) { expect_error({"sample", "teapot"}, 2, "globe"); }

TEST_F(Cli, TheGlobeIsSimulatedAndPrinted) {
  const printer::IppPrinter there("exit 0");
  DaemonProcess::Options real;
  real.extra = "[printer]\naddress = \"" + there.address().uri + "\"\npatience_s = 300\n";
  start(real);
  const std::string sample = (folder_.path() / "sample").string();
  ASSERT_EQ(client({"sample", "globe", "--out", sample}).status, 0);
  const Outcome ended = client({"submit", "simulate", "--mesh", sample + "/globe.obj", "--dpi",
                                "50", "--out", out().string()});
  ASSERT_EQ(ended.status, 0) << ended.err;
  for (const char* picture : {"film.png", "stretch.png", "predicted.png"})
    EXPECT_TRUE(content(out() / picture).starts_with("\x89PNG")) << picture;
  const std::string paper = (folder_.path() / "paper").string();
  const json printed = client_json(
      {"submit", "print-image", "--simulate-job", "1", "--job-name", "globe 1", "--out", paper});
  EXPECT_EQ(printed.at("printImage").at("simulateJob"), "jobs/1");
  const std::string pdf = content(paper + "/print.pdf");
  EXPECT_TRUE(pdf.starts_with("%PDF"));
  // The same PDF results from a retry and from the downloaded film image.
  ASSERT_EQ(client({"retry", "2"}).status, 0);
  ASSERT_EQ(client({"watch", "3"}).status, 0);
  ASSERT_EQ(client({"download", "3", "print.pdf", "--out", paper + "/again"}).status, 0);
  EXPECT_TRUE(content(paper + "/again/print.pdf") == pdf);
  const Outcome by_hand =
      client({"submit", "print-image", "--film-image", (out() / "film.png").string(), "--dpi", "50",
              "--job-name", "globe 1", "--out", paper + "/hand"});
  ASSERT_EQ(by_hand.status, 0) << by_hand.err;
  EXPECT_TRUE(content(paper + "/hand/print.pdf") == pdf);
  const Outcome placed =
      client({"submit", "template", "--simulate-job", "1", "--out", paper + "/where"});
  ASSERT_EQ(placed.status, 0) << placed.err;
  EXPECT_TRUE(content(paper + "/where/placement.pdf").starts_with("%PDF"));
  // Prints on paper.
  const Outcome sent = client({"print", "2", "--out", paper + "/record"});
  ASSERT_EQ(sent.status, 0) << sent.err;
  EXPECT_NE(sent.err.find("completed"), std::string::npos) << sent.err;
  EXPECT_TRUE(content(there.spooled()) == pdf);
  EXPECT_EQ(json::parse(content(paper + "/record/report.json")).at("outcome"), "SUCCEEDED");
}

TEST_F(Cli, PreviewRespondsWithoutAJob) {
  start();
  const json preview =
      client_json({"preview", "--mesh", mesh("a"), "--film", "A3", "--depth-mm", "12"});
  EXPECT_EQ(preview.at("coverage"), 0.5);
  EXPECT_EQ(preview.at("stretchP95"), 2);
  EXPECT_EQ(preview.at("stretchMax"), "NaN") << "unknown";
  const Outcome shown = client({"preview", "--mesh", mesh("a")});
  EXPECT_NE(shown.out.find("film reaches 50 % of the surface"), std::string::npos) << shown.out;
  EXPECT_NE(shown.err.find("warning: m (w)"), std::string::npos) << shown.err;
  expect_error({"preview", "--mesh", mesh("exit 3 line 7 is wrong")}, 3, "line 7 is wrong");
  EXPECT_TRUE(client_json({"list"}).at("jobs").empty());
}

TEST_F(Cli, InspectShowsWhatAModelIs) {
  start();
  const Outcome shown =
      client({"inspect", mesh("a"), "--glb", (folder_.path() / "shown.glb").string()});
  ASSERT_EQ(shown.status, 0) << shown.err;
  EXPECT_NE(shown.out.find("OBJ"), std::string::npos) << shown.out;
  EXPECT_NE(shown.err.find("warning: m (w)"), std::string::npos) << shown.err;
  EXPECT_TRUE(content(folder_.path() / "shown.glb").starts_with("glTF"));
  EXPECT_EQ(client_json({"inspect", mesh("a")}).at("shownTriangles"), 3);
  expect_error({"inspect", mesh("plain")}, 3, "m.png");
  expect_error({"inspect", mesh("a"), mesh("a"), "--glb", "both.glb"}, 3, "single model");
}

TEST_F(Cli, PrintNeedsAPrinterAndPages) {
  start();
  submit("sleep 0");
  ASSERT_EQ(client({"watch", "1"}).status, 0);
  expect_error({"print", "1"}, 3, "name a print-image job");
  ASSERT_EQ(client({"submit", "print-image", "--simulate-job", "1", "--wait"}).status, 0);
  expect_error({"print", "2"}, 3, "printer.address");
  expect_error({"submit", "print-image", "--out", "x"}, 2, "--film-image or --simulate-job");
  expect_error({"submit", "template", "--simulate-job", "1", "--scale", "2"}, 2, "--scale");
}

TEST_F(Cli, SubmitPrintsTheWarningsOfTheReport) {
  start();
  const std::string warned = mesh("warn the film tears");
  const Outcome ended = client({"submit", "simulate", "--mesh", warned, "--wait"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.err.find("hydroprint: warning: the film tears (surface)\n"), std::string::npos)
      << ended.err;
  const Outcome report = client({"report", "1"});
  EXPECT_NE(report.out.find("warning: the film tears (surface)\n"), std::string::npos)
      << report.out;
  const json whole = client_json({"report", "1"});
  EXPECT_EQ(whole.at("simulate").at("run").at("warnings").at(0).at("code"), "FILM_TORN");
  expect_error({"report", "9"}, 3, "jobs/9 does not exist");
  const Outcome silent = client({"submit", "simulate", "--mesh", mesh("sleep 0"), "--wait"});
  EXPECT_EQ(silent.status, 0) << silent.err;
  EXPECT_EQ(silent.err.find("warning"), std::string::npos) << silent.err;
}

/// Fixture with a folder of frames like those of hydroprint-capture, for the fake worker.
class CalibrateCli : public Cli {
 protected:
  CalibrateCli() {
    start();
    std::filesystem::create_directory(folder_.path() / "frames");
    folder_.write("frames/frames.json", "{}");
    folder_.write("frames/frame-0001.png", "depths");
    layout_ = folder_.write("layout.toml", "").string();
  }
  Arguments calibrate(const std::string& work, const Arguments& more = {}) const {
    Arguments out{"calibrate", "--mesh", mesh(work), "--frames", (folder_.path() / "frames"),
                  "--layout",  layout_};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
  std::string layout_;
};

TEST_F(CalibrateCli, CalibratePrintsItsResultAndSimulateUsesIt) {
  const Outcome ended = client(calibrate("sleep 0.1", {"--scale", "2", "--out", out()}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  for (const char* words :
       {"jobs/1\n", "alignment.png", "calibrations/1 (active)", "surface position error: 0.40 mm",
        "1 of 2 markers", "marker near left out: hidden", "from the nominal pose: turn"}) {
    EXPECT_NE(ended.out.find(words), std::string::npos) << words << ended.out;
  }
  EXPECT_TRUE(std::filesystem::exists(out() / "report.json"));
  const json job = client_json(
      {"submit", "simulate", "--mesh", mesh("sleep 0.1"), "--calibration", "active", "--wait"});
  EXPECT_EQ(job.at("simulate").at("calibration"), "calibrations/1");
  EXPECT_EQ(job.at("simulate").at("scale"), 2);
  expect_error({"submit", "simulate", "--mesh", mesh("sleep 0.2"), "--calibration", "1"}, 3,
               "another object");
  EXPECT_EQ(client({"submit", "simulate", "--mesh", mesh("sleep 0.2"), "--calibration", "1",
                    "--allow-stale-calibration"})
                .status,
            0);
  expect_error({"submit", "simulate", "--mesh", mesh("x"), "--calibration", "1", "--scale", "3"}, 2,
               "--scale");
  expect_error(calibrate("reason MIRRORED\nexit 3 it is its mirror image"), 3, "mirror image");
  expect_error({"calibrate", "--mesh", mesh("x"), "--frames", folder_.path()}, 3, "frames.json");
  expect_error({"calibrate", "--mesh", mesh("x")}, 3, "camera.device");
  expect_error({"capture"}, 3, "camera.device");
}

TEST_F(CalibrateCli, CalibrationsAreListedShownEnteredActivatedAndDeleted) {
  ASSERT_EQ(client(calibrate("sleep 0.1")).status, 0);
  const Outcome lens = client(
      {"calibrate-camera", "--frames", folder_.path() / "frames", folder_.path() / "frames"});
  ASSERT_EQ(lens.status, 0) << lens.err;
  EXPECT_NE(lens.out.find("12 views"), std::string::npos) << lens.out;
  const std::string pose =
      folder_.write("pose.json", R"({"rotation_wxyz":[1,0,0,0],"translation_mm":[1,2,0]})");
  const json entered = client_json(
      {"calibrations", "enter", "--mesh", mesh("sleep 0.1"), "--pose", pose, "--name", "by eye"});
  EXPECT_EQ(entered.at("name"), "calibrations/3");
  const json all = client_json({"calibrations", "list"}).at("calibrations");
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].at("displayName"), "by eye");
  EXPECT_EQ(all[1].at("kind"), "CAMERA");
  EXPECT_EQ(all[2].at("active"), false);
  EXPECT_EQ(client_json({"calibrations", "activate", "1"}).at("active"), true);
  EXPECT_EQ(client_json({"calibrations", "show", "active"}).at("name"), "calibrations/1");
  EXPECT_EQ(client_json({"calibrations", "show", "1"}).at("covariance").size(), 36U);
  EXPECT_NE(client({"calibrations", "list"}).out.find("by eye"), std::string::npos);
  EXPECT_NE(client({"calibrations", "show", "1"}).out.find("water_z_mm"), std::string::npos);
  expect_error({"delete", "1"}, 3, "calibrations/1");
  EXPECT_EQ(client({"calibrations", "delete", "1"}).status, 0);
  EXPECT_EQ(client({"delete", "1"}).status, 0);
  expect_error({"calibrations", "show", "1"}, 3, "calibrations/1");
}

}  // namespace
}  // namespace hydroprint::tests
