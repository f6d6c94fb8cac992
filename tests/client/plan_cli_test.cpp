// `hydroprint plan` as users run it, with the real daemon and worker and the virtual rig.
#include <gtest/gtest.h>

#include "tests/client/rig_programs.h"
#include "tests/sim/worker/bodies.h"
#include "tests/support/terminal.h"

namespace hydroprint::tests {
namespace {

using Arguments = std::vector<std::string>;
using hydroprint::testing::Terminal;

constexpr char kTwoDips[] = R"([
  {"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0], "depth_mm": 4},
  {"rotation_wxyz": [0, 1, 0, 0], "translation_mm": [0, 0, 0], "depth_mm": 4}])";

/// A ball of radius 15 mm to be dipped from below, then turned over and dipped again.
class PlanCli : public ::testing::Test {
 protected:
  PlanCli() {
    const std::string ball =
        programs_.folder.write("ball.obj", worker::sphere_obj(15, 12, "0.2 0.6 0.4"));
    const std::string dips = programs_.folder.write("two.json", kTwoDips);
    const auto planned = programs_.client(
        {"submit", "plan", "--mesh", ball, "--immersions", dips, "--film", "50x50", "--dpi", "50",
         "--model", "stokes", "--dip-speed-mm-per-s", "10", "--name", "ball", "--wait"});
    EXPECT_EQ(planned.status, 0) << planned.err;
  }

  hydroprint::testing::Ended next(const Arguments& more = {}) const {
    Arguments all{"plan", "next", "1"};
    all.insert(all.end(), more.begin(), more.end());
    return programs_.client(all);
  }
  std::string table() const { return programs_.client({"plan", "show", "1"}).out; }
  std::string out() const { return programs_.folder.path() / "dip"; }

  /// Does the next step; expects what it prints to end with these words.
  void expect_next(const Arguments& more, const std::string& words) const {
    const auto ended = next(more);
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_NE(ended.out.find(words), std::string::npos) << ended.out;
  }

  RigPrograms programs_{DaemonProcess::Options()};
};

TEST_F(PlanCli, FollowsAPlanToItsEnd) {
  programs_.make_ready(8);
  EXPECT_NE(table().find("next: hydroprint plan next 1\n  dip 1 of 2: "), std::string::npos)
      << table();
  for (const std::string dip : {"1", "2"}) {
    SCOPED_TRACE(dip);
    // With --yes-to-all, a dip takes the present position as first contact.
    ASSERT_EQ(programs_.client({"rig", "move", "8", "--speed", "10"}).status, 0);
    const Arguments into{"--out", out() + dip, "--yes-to-all"};
    expect_next(into, "next: hydroprint plan next 1\n  dip " + dip + " of 2: lay out");
    expect_next(into, "next: hydroprint plan next 1\n  dip " + dip + " of 2: print");
    EXPECT_TRUE(content(out() + dip + "/print.pdf").starts_with("%PDF"));
    expect_next(into, dip == "1" ? "dip 2 of 2: compute" : "all 2 dips are done");
    EXPECT_FALSE(content(out() + dip + "/positions.csv").empty());
  }
  expect_next({}, "all 2 dips are done");
  expect_next({"--immersion", "2"}, "all 2 dips are done");
  EXPECT_NE(table().find("\nall 2 dips are done\n"), std::string::npos) << table();
  const auto progress = programs_.client_json({"plan", "show", "1"});
  EXPECT_EQ(progress.at("dips").at(1).at("step"), "DONE");
  const auto dip = programs_.client_json({"show", progress["dips"][1]["dipJob"]});
  EXPECT_EQ(dip.at("displayName"), "ball, dip 2 of 2");
  EXPECT_EQ(dip.at("dipStatus").at("immersion"), 2);
}

TEST_F(PlanCli, AnUnfinishedDipIsResumedAtATerminal) {
  expect_next({"--immersion", "2"}, "dip 2 of 2: lay out");
  expect_next({"--out", out()}, "dip 2 of 2: print");
  const auto missing = next({"--immersion", "3"});
  EXPECT_EQ(missing.status, 3);
  EXPECT_NE(missing.err.find("jobs/1 has 2 dips"), std::string::npos) << missing.err;
  EXPECT_EQ(programs_.client({"plan", "next", "2"}).status, 3) << "a simulate job is not a plan";
  EXPECT_EQ(programs_.client({"plan"}).status, 2);
  const auto refused = next();
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("needs a terminal"), std::string::npos) << refused.err;
  programs_.make_ready(8);
  expect_next({"--no-guide"}, "dip 2 of 2: follow the steps of jobs/4");
  EXPECT_NE(table().find("confirm steps of jobs/4"), std::string::npos) << table();
  EXPECT_EQ(next().status, 3) << "the guide needs a terminal";
  Terminal at(programs_.command({"plan", "next", "1", "--out", out()}));
  ASSERT_TRUE(at.shows("PRINT_FILM:")) << at.screen();
  ASSERT_TRUE(at.shows("Enter")) << at.screen();
  at.type("\n");
  ASSERT_TRUE(at.shows("LOAD_OBJECT:")) << at.screen();
  at.type("\x03");
  EXPECT_EQ(at.wait(), 130) << at.screen();
  EXPECT_NE(table().find("note: jobs/4 is CANCELLED"), std::string::npos) << table();
  EXPECT_NE(table().find("next: hydroprint plan next 1\n  dip 2 of 2: print"), std::string::npos)
      << "the film of jobs/2 is still good" << table();
}

}  // namespace
}  // namespace hydroprint::tests
