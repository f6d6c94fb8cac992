// The verb `hydroprint-worker validate` from a user's point of view: coarse experiments and their
// report.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "hydroprint/v1/report.pb.h"
#include "sim/image/io/image_file.h"
#include "tests/sim/worker/report_file.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"
#include "tests/support/timing.h"

namespace hydroprint::worker {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Ended;
using Arguments = std::vector<std::string>;

const std::string kWorker = testing::program_path("hydroprint-worker");
const std::vector<std::string> kExperiments = {"repeatability", "accuracy", "models", "thickness",
                                               "stretch",       "objects",  "bowl"};
const std::vector<std::string> kSample = {"models", "bowl"};

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

/// A quick run of these experiments and its report.
struct Validation {
  testing::TemporaryFolder folder;
  Ended ended;

  [[nodiscard]] fs::path out() const { return folder.path() / "out"; }
  [[nodiscard]] json report() const { return json::parse(content(out() / "report.json")); }
  [[nodiscard]] double value(const std::string& name) const {
    const json all = report();  // a named copy, because a temporary would not outlive the loop
    for (const json& experiment : all.at("experiments")) {
      for (const json& figure : experiment.at("figures")) {
        if (figure.at("name") == name) return figure.at("value");
      }
    }
    ADD_FAILURE() << "the report has no figure " << name;
    return std::nan("");
  }
};

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ",") + name;
  return all;
}

/// Each selection of experiments is run once and shared by all tests.
const Validation& run_of(const std::vector<std::string>& experiments) {
  static std::map<std::string, Validation> runs;
  const auto [place, is_new] = runs.try_emplace(joined(experiments));
  Validation& run = place->second;
  if (is_new) {
    Arguments command = {kWorker, "validate", "--quick", "--threads",
                         "2",     "--json",   "--out",   run.out().string()};
    if (experiments != kExperiments) command.insert(command.end(), {"--only", place->first});
    run.ended = testing::run(command);
  }
  EXPECT_EQ(run.ended.status, 0) << run.ended.err;
  return run;
}

/// Reports of a few short experiments in tests/run, and of all experiments in tests/campaign.
class QuickReport : public ::testing::TestWithParam<std::vector<std::string>> {
 protected:
  const std::vector<std::string>& experiments = GetParam();
  const Validation& run = run_of(experiments);
};

INSTANTIATE_TEST_SUITE_P(Sample, QuickReport, ::testing::Values(kSample));
INSTANTIATE_TEST_SUITE_P(All, QuickReport, ::testing::Values(kExperiments));

TEST_P(QuickReport, HasExactlyTheExperimentsAndTheirPictures) {
  const json all = run.report();
  (void)testing::read_message<v1::ValidateReport>(run.out() / "report.json");
  EXPECT_EQ(all.at("run").at("verb"), "validate");
  EXPECT_EQ(all.at("quick"), true);
  std::vector<std::string> names;
  std::set<std::string> files = {"report.html", "report.json"};
  for (const json& experiment : all.at("experiments")) {
    names.push_back(experiment.at("name"));
    EXPECT_FALSE(experiment.at("paper").get<std::string>().empty());
    EXPECT_FALSE(experiment.at("figures").empty()) << names.back();
    EXPECT_FALSE(experiment.at("tables").empty()) << names.back();
    EXPECT_FALSE(experiment.at("pictures").empty()) << names.back();
    for (const json& picture : experiment.at("pictures")) files.insert(picture.at("file"));
  }
  EXPECT_EQ(names, experiments);
  EXPECT_EQ(names_in(run.out()), files);
  std::set<std::string> told = {"report.json"};
  for (const json& name : all.at("run").at("artifacts")) told.insert(name);
  EXPECT_EQ(told, files);
  EXPECT_EQ(names_in(run.folder.path()), std::set<std::string>{"out"});
}

TEST_P(QuickReport, PicturesShowSomething) {
  for (const std::string& name : names_in(run.out())) {
    if (!name.ends_with(".png")) continue;
    const auto picture = image::read_image(run.out() / name, {});
    ASSERT_TRUE(picture) << picture.error().message;
    std::set<std::uint64_t> colours;
    for (const image::Texel& t : picture->image.texels) {
      colours.insert(std::uint64_t{t.r} << 32 | std::uint64_t{t.g} << 16 | t.b);
      if (colours.size() > 50) break;
    }
    EXPECT_GT(colours.size(), 50U) << name;
  }
}

TEST_P(QuickReport, PageIsWellFormedAndItsLinksLeadSomewhere) {
  const std::string page = content(run.out() / "report.html");
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_EQ(page.find("<script"), std::string::npos);
  std::vector<std::string> open;
  std::set<std::string> ids, links, sources;
  static const std::regex kTag(R"(<(/?)([a-z0-9]+)([^<>]*?)(/?)>)");
  static const std::regex kAttribute(R"rx((href|src|id)="([^"]*)")rx");
  for (std::sregex_iterator tag(page.begin(), page.end(), kTag), end; tag != end; ++tag) {
    const std::string name = (*tag)[2], attributes = (*tag)[3];
    for (std::sregex_iterator a(attributes.begin(), attributes.end(), kAttribute); a != end; ++a) {
      std::set<std::string>& kind = (*a)[1] == "id" ? ids : (*a)[1] == "src" ? sources : links;
      kind.insert((*a)[2]);
    }
    if ((*tag)[1].length() > 0) {
      ASSERT_FALSE(open.empty());
      ASSERT_EQ(open.back(), name);
      open.pop_back();
    } else if ((*tag)[4].length() == 0) {
      open.push_back(name);
    }
  }
  EXPECT_TRUE(open.empty());
  EXPECT_EQ(ids, std::set<std::string>(experiments.begin(), experiments.end()));
  EXPECT_GT(sources.size(), experiments.size());
  for (const std::string& source : sources) EXPECT_TRUE(fs::exists(run.out() / source)) << source;
  for (const std::string& link : links) {
    EXPECT_TRUE(link.starts_with("#") ? ids.contains(link.substr(1)) : fs::exists(run.out() / link))
        << link;
  }
  const json all = run.report();  // a named copy, because a temporary would not outlive the loop
  for (const json& experiment : all.at("experiments")) {
    EXPECT_NE(page.find("<h2>" + experiment.at("title").get<std::string>() + "</h2>"),
              std::string::npos);
  }
}

TEST_P(QuickReport, CountsPassedFigures) {
  int passed = 0, failed = 0;
  const json all = run.report();  // a named copy, because a temporary would not outlive the loop
  for (const json& experiment : all.at("experiments")) {
    for (const json& figure : experiment.at("figures")) {
      if (!figure.contains("limit")) continue;
      const double x = figure.at("value");
      const json& limit = figure.at("limit");
      const bool is_within =
          x >= limit.value("least", -HUGE_VAL) && x <= limit.value("most", HUGE_VAL);
      EXPECT_EQ(figure.at("passed"), is_within) << figure;
      ++(is_within ? passed : failed);
    }
  }
  EXPECT_EQ(run.report().at("passed"), passed);
  EXPECT_EQ(run.report().at("failed"), failed);
  const json summary = json::parse(run.ended.out).at("report");
  EXPECT_EQ(summary.at("passed"), passed);
  EXPECT_EQ(summary.at("failed"), failed);
  EXPECT_GT(passed, experiments == kSample ? 4 : 10);
}

TEST(Figures, FilmIsUndisplacedAtFirstContact) {
  const Validation& run = run_of({"repeatability", "stretch"});
  // At first contact, landing points vary by the same amount as the drawn errors.
  EXPECT_NEAR(run.value("spread_at_contact_ratio"), 1, 0.01);
  EXPECT_NEAR(run.value("sphere_stretch_at_contact"), 1, 0.01);
  // At most four standard deviations of the errors, which are 0.3 mm, 0.3 degrees at a distance of
  // 60 mm, and 0.5 mm, in two directions.
  EXPECT_GT(run.value("spread_at_contact_mm"), 0.3);
  EXPECT_LT(run.value("spread_at_contact_mm"), 2);
}

TEST(Figures, TheReferenceIsCloserToTheExactSolution) {
  const Validation& run = run_of({"accuracy"});
  // The error is of second order: 0.6 times the lengths leave 0.36 of it. The error of the
  // triangles that represent the sphere remains.
  EXPECT_LT(run.value("exact_sphere_fine_max_mm"), 0.6 * run.value("exact_sphere_usual_max_mm"));
  EXPECT_LT(run.value("exact_sphere_fine_max_mm"), 0.2);
  EXPECT_GT(run.value("sphere_far_pole_max_mm"), run.value("sphere_to_equator_max_mm"));
}

TEST(Figures, KnownInkReducesItsError) {
  const Validation& run = run_of({"thickness"});
  EXPECT_GT(run.value("thickness_off_mean_mm"), 0.1);
  EXPECT_LT(run.value("thickness_on_to_off"), 0.25);
  EXPECT_LT(run.value("second_pass_to_first"), 0.5);
}

TEST(Figures, FilmModelsDifferWhereTheFilmIsStretched) {
  const Validation& run = run_of(kSample);
  EXPECT_GT(run.value("bend_to_legs_ratio"), 1);
}

TEST(Figures, BowlIsRecognisedAsUnprintable) {
  const Validation& run = run_of(kSample);
  EXPECT_EQ(run.value("mouth_down_recognised"), 1);
  EXPECT_EQ(run.value("upright_recognised"), 1);
  EXPECT_GT(run.value("floor_stretch"), 3);
  // The coarse steps miss a part of the growth at the rim.
  EXPECT_NEAR(run.value("floor_stretch_to_exact"), 1, 0.1);
}

class Validate : public ::testing::Test {
 protected:
  [[nodiscard]] std::string out() const { return folder.path() / "out"; }
  void expect_refusal(const Arguments& more, const std::string& words) const {
    Arguments command = {kWorker, "validate"};
    command.insert(command.end(), more.begin(), more.end());
    const Ended ended = testing::run(command);
    EXPECT_EQ(ended.status, 2) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
    EXPECT_TRUE(names_in(folder.path()).empty());
  }

  testing::TemporaryFolder folder;
};

TEST_F(Validate, RefusesBadFlags) {
  expect_refusal({"--out", out(), "--only", "acuracy"},
                 "--only: unknown experiment 'acuracy'. Choose from repeatability, accuracy");
  expect_refusal({"--out", out(), "--mesh", "ball.obj"}, "--mesh");
  expect_refusal({"--out", out(), "--threads", "0"},
                 "--threads: 0 is out of range. The value must be from 1 to 256");
  expect_refusal({"--quick"}, "--out");
}

TEST_P(QuickReport, IsReplacedByTheNextRunWithTheRequestedExperiments) {
  const testing::TemporaryFolder folder;
  const fs::path again = folder.path() / "out";
  fs::copy(run.out(), again);
  const auto is_model = [](const std::string& name) {
    return name.starts_with("validate-models-");
  };
  const Ended ended =
      testing::run({kWorker, "validate", "--quick", "--only", "models", "--out", again.string()});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find((again / "report.html").string()), std::string::npos);
  std::set<std::string> wanted = {"report.html", "report.json"};
  for (const std::string& name : names_in(run.out())) {
    if (is_model(name)) wanted.insert(name);
  }
  EXPECT_GT(wanted.size(), 2U);
  EXPECT_EQ(names_in(again), wanted);
  // Experiments share bodies and films, but no experiment may change the input of another.
  const auto models_of = [](const fs::path& in) {
    const json all = json::parse(content(in / "report.json"));
    for (const json& e : all.at("experiments")) {
      if (e.at("name") == "models") return e;
    }
    return json();
  };
  EXPECT_EQ(models_of(again), models_of(run.out()));
}

TEST_F(Validate, LeavesNothingWhenItIsCancelled) {
  // Cancelled in the second experiment, which takes much longer than the first.
  testing::Process process(
      {kWorker, "validate", "--quick", "--only", "models,stretch", "--out", out()});
  const auto has_written = [&] {
    for (const std::string& name : names_in(folder.path())) {
      if (!names_in(folder.path() / name).empty()) return true;
    }
    return false;
  };
  ASSERT_TRUE(testing::wait_until(has_written, 300));
  ASSERT_TRUE(process.running());
  process.signal(SIGTERM);
  const Ended ended = process.wait();
  EXPECT_EQ(ended.status, 130) << ended.err;
  EXPECT_TRUE(names_in(folder.path()).empty());
}

}  // namespace
}  // namespace hydroprint::worker
