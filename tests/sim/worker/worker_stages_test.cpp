// The stages that runs report, compared with the stages used for the estimated time.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "sim/worker/command_line.h"
#include "sim/worker/common/artifact_task.h"
#include "tests/sim/worker/bodies.h"
#include "tests/sim/worker/plan_fixture.h"

namespace hydroprint::worker {
namespace {

using Names = std::vector<std::string>;

class Stages : public PlanWorker {
 protected:
  void SetUp() override {
    PlanWorker::SetUp();
    std::filesystem::copy_file(path("texture.png"), path("film.png"));
  }

  /// The stages of a run in order, from its progress pipe.
  [[nodiscard]] Names reported(Arguments command) const {
    ProcessOptions options;
    options.files = {{5, folder.path() / "progress"}};
    command.insert(command.end(), {"--progress-fd", "5"});
    const Ended ended = testing::run(command, options);
    EXPECT_EQ(ended.status, 0) << ended.err;
    Names names;
    std::ifstream lines(path("progress"));
    for (std::string line; std::getline(lines, line);) {
      const std::string stage = nlohmann::json::parse(line)["stage"];
      if (names.empty() || names.back() != stage) names.push_back(stage);
    }
    std::filesystem::remove(path("progress"));
    return names;
  }
};

Names listed(const Arguments& command) {
  std::vector<const char*> argv;
  for (const std::string& argument : command) argv.push_back(argument.c_str());
  const CommandLine parsed = parse_command_line(static_cast<int>(argv.size()), argv.data());
  EXPECT_EQ(parsed.action, CommandLine::Action::kRun) << parsed.error.message;
  const auto* const task = dynamic_cast<const ArtifactTask*>(parsed.task.get());
  if (task == nullptr) return {};
  Names names;
  for (const Stage& stage : task->stages()) {
    EXPECT_GT(stage.weight, 0) << stage.name;
    names.push_back(stage.name);
  }
  return names;
}

/// Whether `some` equals `all` after removing some names.
bool is_part_of(const Names& some, const Names& all) {
  auto next = all.begin();
  for (const std::string& name : some) {
    next = std::find(next, all.end(), name);
    if (next == all.end()) return false;
    ++next;
  }
  return true;
}

TEST_F(Stages, OfASimulationComeAsListed) {
  for (const Arguments& flags :
       {Arguments{},
        {"--model", "stokes"},
        {"--artifacts", "map"},
        {"--artifacts", "map", "--inertia", "--depth-mm", "6"},
        {"--artifacts", "map", "--ink-passes", "0"},
        {"--artifacts", "map", "--ink-passes", "2", "--dpi", "600"},
        {"--artifacts", "map", "--ink-image", path("texture.png")},
        {"--artifacts", "map", "--model", "stokes", "--ink-image", path("texture.png")}}) {
    Arguments textured{"--texture", path("texture.png")};
    textured.insert(textured.end(), flags.begin(), flags.end());
    EXPECT_EQ(reported(simulate(textured)), listed(simulate(textured)))
        << ::testing::PrintToString(flags);
  }
}

TEST_F(Stages, OfAPredictionComeAsListed) {
  for (const Arguments& flags : {Arguments{},
                                 {"--artifacts", "map"},
                                 {"--artifacts", "map", "--inertia", "--depth-mm", "6"},
                                 {"--artifacts", "map", "--ink-passes", "0"},
                                 {"--artifacts", "map", "--ink-image", path("texture.png")},
                                 {"--artifacts", "map", "--model", "stokes"}}) {
    EXPECT_EQ(reported(predict(flags)), listed(predict(flags))) << ::testing::PrintToString(flags);
  }
}

TEST_F(Stages, OfAPlanComeAsListed) {
  write_immersions({{1, 0, 0, 0}});
  for (const Arguments& flags : {Arguments{},
                                 {"--model", "sheet", "--ink-passes", "0"},
                                 {"--model", "sheet", "--ink-passes", "2"}}) {
    EXPECT_EQ(reported(plan(flags)), listed(plan(flags))) << ::testing::PrintToString(flags);
  }
}

TEST_F(Stages, OfADipOfAPlanComeAsListed) {
  (void)planned({});
  std::filesystem::rename(out(), path("plan"));
  const Arguments stokes = simulate({"--texture", path("texture.png"), "--plan", path("plan"),
                                     "--immersion", "2", "--film", "60x70"});
  Arguments sheet = stokes;
  sheet.insert(sheet.end(), {"--model", "sheet", "--ink-passes", "1"});
  for (const Arguments& command : {stokes, sheet}) EXPECT_EQ(reported(command), listed(command));
}

TEST_F(Stages, UnusedStagesAreLeftOut) {
  // A model without colours has no ink, and so needs no stages for it.
  folder.write("bare.obj", sphere_obj(12, 12));
  const Arguments colourless = simulate({"--mesh", path("bare.obj"), "--artifacts", "map"}, false);
  const Arguments patient =
      simulate({"--artifacts", "map", "--texture", path("texture.png"), "--ink-passes", "10"});
  for (const Arguments& command : {colourless, patient}) {
    const Names some = reported(command), all = listed(command);
    EXPECT_LT(some.size(), all.size());
    EXPECT_TRUE(is_part_of(some, all)) << ::testing::PrintToString(some);
  }
}

}  // namespace
}  // namespace hydroprint::worker
