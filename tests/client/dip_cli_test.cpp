// `hydroprint dip` as users run it, with the real daemon and the virtual rig.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <iterator>
#include <thread>

#include "tests/client/rig_programs.h"
#include "tests/support/terminal.h"

namespace hydroprint::tests {
namespace {

using namespace std::chrono_literals;
using hydroprint::testing::Terminal;
using nlohmann::json;
using Arguments = std::vector<std::string>;

// A small and fast dip, with timers long enough to be observed.
const Arguments kSmall{"--speed",        "10", "--hold-s",           "0", "--soak-s", "1",
                       "--clearance-mm", "3",  "--activator-wait-s", "1", "--out"};

class DipCli : public ::testing::Test {
 protected:
  DipCli() { programs_.make_ready(8); }

  Arguments dip(const Arguments& flags, const std::string& depth_mm = "5") const {
    Arguments arguments{"dip", "--depth-mm", depth_mm};
    arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
    arguments.push_back(out().string());
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return arguments;
  }
  json create() const { return programs_.client_json(dip({"--no-guide"})); }
  std::filesystem::path out() const { return programs_.folder.path() / "record"; }
  json report() const { return json::parse(std::ifstream(out() / "report.json"), nullptr, false); }
  std::string step_of(const std::string& job) const {
    return programs_.client_json({"show", job}).at("dipStatus").at("step");
  }
  bool comes_to(const std::string& job, const std::string& step) const {
    for (int i = 0; i < 100; ++i) {
      if (step_of(job) == step) return true;
      std::this_thread::sleep_for(100ms);
    }
    return false;
  }

  RigPrograms programs_;
};

TEST_F(DipCli, GuidesThroughEveryStep) {
  Terminal dip_at(programs_.command(dip({})));
  const auto confirm = [&](const std::string& step) {
    ASSERT_TRUE(dip_at.shows(step + ":")) << dip_at.screen();
    ASSERT_TRUE(dip_at.shows("Enter")) << dip_at.screen();
    dip_at.type("\n");
  };
  confirm("PRINT_FILM");
  confirm("LOAD_OBJECT");
  ASSERT_TRUE(dip_at.shows("FIND_CONTACT:")) << dip_at.screen();
  ASSERT_TRUE(dip_at.shows("Enter")) << dip_at.screen();
  dip_at.hold("j", 1000ms);
  ASSERT_TRUE(programs_.rests());
  const double contact_mm = programs_.rig.position_mm();
  EXPECT_GT(contact_mm, 8.5);
  // Confirms repeatedly, because the daemon may not have seen the standstill yet.
  ASSERT_TRUE(wait_until([&] {
    dip_at.type("\n");
    return dip_at.shows("CLEAR:", 300ms);
  })) << dip_at.screen();
  confirm("LAY_FILM");
  ASSERT_TRUE(dip_at.shows("SOAK:")) << dip_at.screen();
  ASSERT_TRUE(dip_at.shows("left")) << dip_at.screen();
  confirm("SPRAY_ACTIVATOR");
  ASSERT_TRUE(dip_at.shows("ACTIVATE:")) << dip_at.screen();
  confirm("START_DIP");
  ASSERT_TRUE(dip_at.shows("DESCEND:")) << dip_at.screen();
  ASSERT_TRUE(dip_at.shows("RETRACT:")) << dip_at.screen();
  EXPECT_EQ(dip_at.wait(60s), 0) << dip_at.screen();
  EXPECT_TRUE(dip_at.shows("dipped 5.00 mm deep at 10.00 mm/s, constant within 0."))
      << dip_at.screen();
  EXPECT_TRUE(dip_at.is_cooked());
  EXPECT_NEAR(report().at("axis").at("contact_mm"), contact_mm, 0.1);
  EXPECT_GT(std::filesystem::file_size(out() / "positions.csv"), 1000U);
}

TEST_F(DipCli, EnterTypedAheadConfirmsNothing) {
  Terminal dip_at(programs_.command(dip({})));
  dip_at.type("\n\n\n\n");
  ASSERT_TRUE(dip_at.shows("PRINT_FILM:")) << dip_at.screen();
  EXPECT_FALSE(dip_at.shows("LOAD_OBJECT:", 1s)) << dip_at.screen();
}

TEST_F(DipCli, CtrlCAbortsTheDipAndPrintsInstructions) {
  Terminal dip_at(programs_.command(dip({})));
  ASSERT_TRUE(dip_at.shows("PRINT_FILM:")) << dip_at.screen();
  dip_at.type("\n");
  ASSERT_TRUE(dip_at.shows("LOAD_OBJECT:")) << dip_at.screen();
  dip_at.type("\x03");
  EXPECT_EQ(dip_at.wait(), 130) << dip_at.screen();
  const json job = programs_.client_json({"list"}).at("jobs").at(0);
  EXPECT_EQ(job.at("state"), "CANCELLED");
  EXPECT_TRUE(dip_at.shows(job.at("dipStatus").at("instruction").get<std::string>().substr(0, 40)))
      << dip_at.screen();
  EXPECT_TRUE(dip_at.is_cooked());
}

TEST_F(DipCli, CtrlCDuringTheDescentStopsTheAxis) {
  Terminal dip_at(programs_.command(dip({"--yes-to-all"}, "100")));
  ASSERT_TRUE(dip_at.shows("DESCEND:")) << dip_at.screen();
  ASSERT_TRUE(programs_.moves());
  dip_at.type("\x03");
  EXPECT_EQ(dip_at.wait(), 130) << dip_at.screen();
  EXPECT_TRUE(programs_.rests());
  EXPECT_LT(programs_.rig.position_mm(), 100);
}

TEST_F(DipCli, AStopThatIsNotObeyedRingsTheBell) {
  Terminal dip_at(programs_.command(dip({"--yes-to-all"}, "100")));
  ASSERT_TRUE(dip_at.shows("DESCEND:")) << dip_at.screen();
  ASSERT_TRUE(programs_.moves());
  programs_.rig.act("press deaf");
  dip_at.type("\x03");
  EXPECT_TRUE(dip_at.shows("\ahydroprint: PRESS THE STOP BUTTON ON THE RIG")) << dip_at.screen();
  EXPECT_NE(dip_at.wait(), 0);
}

TEST_F(DipCli, TheDipContinuesWhenTheClientIsKilled) {
  Terminal dip_at(programs_.command(dip({"--yes-to-all"})));
  ASSERT_TRUE(dip_at.shows("DESCEND:")) << dip_at.screen();
  ::kill(dip_at.pid(), SIGKILL);
  dip_at.wait();
  EXPECT_EQ(programs_.client({"watch", "1"}).status, 0);
}

TEST_F(DipCli, YesToAllNeedsNoTerminal) {
  const auto ended = programs_.client(dip({"--yes-to-all", "--water-temperature-c", "24"}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("dipped 5.0"), std::string::npos) << ended.out;
  EXPECT_NE(ended.err.find("DESCEND: "), std::string::npos) << ended.err;
  EXPECT_EQ(report().at("parameters").at("water_temperature_c"), 24);
  EXPECT_TRUE(std::filesystem::exists(out() / "positions.csv"));
}

TEST_F(DipCli, WithoutATerminalItNamesTheAlternatives) {
  const auto ended = programs_.client(dip({}));
  EXPECT_EQ(ended.status, 3);
  EXPECT_NE(ended.err.find("--no-guide"), std::string::npos) << ended.err;
  EXPECT_TRUE(programs_.client_json({"list"}).at("jobs").empty());
}

TEST_F(DipCli, StepsAreConfirmedOneByOne) {
  const std::string job = create().at("name");
  EXPECT_EQ(step_of(job), "PRINT_FILM");
  const auto wrong = programs_.client({"confirm", job, "LAY_FILM"});
  EXPECT_EQ(wrong.status, 3) << wrong.err;
  const auto right = programs_.client({"confirm", job, "print_film"});
  EXPECT_EQ(right.status, 0) << right.err;
  EXPECT_NE(right.out.find("then: hydroprint confirm " + job + " LOAD_OBJECT"), std::string::npos)
      << right.out;
  EXPECT_EQ(programs_.client({"confirm", job, "PRINT_FILM"}).status, 0)
      << "repeating a confirmation is not an error";
  EXPECT_EQ(step_of(job), "LOAD_OBJECT");
  EXPECT_EQ(programs_.client({"confirm", job, "ACTIVATE"}).status, 2)
      << "not confirmed by the operator";
  EXPECT_EQ(programs_.client({"list", "--state", "WAITING_FOR_OPERATOR"}).out.find(job),
            programs_.client({"list"}).out.find(job));
  EXPECT_EQ(programs_.client({"cancel", job}).status, 0);
}

TEST_F(DipCli, WatchPrintsTheStepsAndTheirInstructions) {
  const std::string job = create().at("name");
  hydroprint::testing::Process watch(programs_.command({"watch", job}));
  std::this_thread::sleep_for(500ms);
  for (const char* step : {"PRINT_FILM", "LOAD_OBJECT"})
    EXPECT_EQ(programs_.client({"confirm", job, step}).status, 0);
  EXPECT_EQ(programs_.client({"cancel", job}).status, 0);
  const auto ended = watch.wait();
  EXPECT_EQ(ended.status, 130);
  for (const char* step : {"PRINT_FILM: ", "LOAD_OBJECT: ", "FIND_CONTACT: "})
    EXPECT_NE(ended.out.find(step), std::string::npos) << ended.out;
}

TEST_F(DipCli, TheHolderOfTheLeaseIsNamed) {
  programs_.client({"rig", "lease", "release"});
  programs_.client({"rig", "lease", "acquire", "--purpose", "a vase"}, "alice");
  const auto ended = programs_.client(dip({"--yes-to-all"}));
  EXPECT_EQ(ended.status, 4);
  for (const char* word : {"alice", "a vase", "until 20"})
    EXPECT_NE(ended.err.find(word), std::string::npos) << ended.err;
}

TEST_F(DipCli, TheAcquiredLeaseIsReleased) {
  programs_.client({"rig", "lease", "release"});
  EXPECT_EQ(programs_.client(dip({"--yes-to-all"})).status, 0);
  EXPECT_FALSE(programs_.client_json({"rig", "status"}).contains("lease"));
  create();
  EXPECT_EQ(programs_.client_json({"rig", "status"}).at("lease").at("holder"), "tester")
      << "the open dip needs the lease, because its steps must be confirmed";
}

}  // namespace
}  // namespace hydroprint::tests
