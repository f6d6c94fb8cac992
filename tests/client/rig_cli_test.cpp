// `hydroprint rig` as users run it, with the real daemon and the virtual rig.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "tests/client/rig_programs.h"
#include "tests/daemon/http/http_client.h"
#include "tests/support/paths.h"
#include "tests/support/terminal.h"

namespace hydroprint::tests {
namespace {

using namespace std::chrono_literals;
using hydroprint::testing::Process;
using hydroprint::testing::Terminal;
using nlohmann::json;

constexpr double kSettled_mm = 0.1;  // arrival_mm of the rig's default configuration

class RigCli : public ::testing::Test {
 protected:
  /// Expects one line on stderr that contains these words.
  void expect_error(const std::vector<std::string>& arguments, int status,
                    const std::vector<std::string>& words,
                    const std::string& user = "tester") const {
    const auto ended = programs_.client(arguments, user);
    EXPECT_EQ(ended.status, status) << ended.err;
    for (const std::string& word : words)
      EXPECT_NE(ended.err.find(word), std::string::npos) << word << " is not in: " << ended.err;
    EXPECT_EQ(ended.err.find('\n'), ended.err.size() - 1) << ended.err;
  }

  std::filesystem::path lease_file() const {
    for (const auto& file : std::filesystem::directory_iterator(programs_.runtime() / "hydroprint"))
      return file.path();
    return {};
  }

  /// Time until the axis is at rest, by the virtual rig's clock; 0 or negative if it already is.
  double seconds_to_rest() {
    const double begin_s = programs_.rig.now_s();
    return programs_.rig.rested_s() - begin_s;
  }

  RigPrograms programs_;
};

TEST_F(RigCli, TheLeaseFileIsReadableOnlyByItsOwner) {
  const json lease = programs_.client_json({"rig", "lease", "acquire", "--purpose", "a mug"});
  EXPECT_EQ(lease.at("holder"), "tester");
  EXPECT_EQ(lease.at("purpose"), "a mug");
  struct stat status {};
  ASSERT_EQ(::stat(lease_file().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600U);
  ASSERT_EQ(::stat(lease_file().parent_path().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0700U);
  EXPECT_EQ(programs_.client({"rig", "arm"}).status, 0) << "the next command uses the stored lease";
  EXPECT_EQ(programs_.client({"rig", "lease", "release"}).status, 0);
  EXPECT_TRUE(lease_file().empty());
  expect_error({"rig", "arm"}, 3, {"hydroprint rig lease acquire --purpose"});
}

TEST_F(RigCli, ARefusalNamesTheHolderAndPurposeOfTheLease) {
  programs_.client({"rig", "lease", "acquire", "--purpose", "a mug"}, "alice");
  const json lease = programs_.client_json({"rig", "lease", "show"});
  EXPECT_EQ(lease.at("leaseId"), "") << "the lease id is a secret";
  const std::vector<std::string> words{"alice", "a mug", "until 20", "lease break --reason"};
  expect_error({"rig", "lease", "acquire", "--purpose", "mine"}, 4, words);
  expect_error({"rig", "arm"}, 3, words);
  expect_error({"rig", "arm", "--with-lease", "mine"}, 4, words);
  expect_error({"rig", "jog", "--speed", "1", "--for", "1s"}, 3, words);
  EXPECT_EQ(programs_.client({"rig", "lease", "break", "--reason", "lunch"}).status, 0);
  EXPECT_EQ(programs_.client({"rig", "arm", "--with-lease", "mine"}).status, 0);
  expect_error({"rig", "arm"}, 3, {"which you do not hold"}, "alice");
}

TEST_F(RigCli, ALeaseIsRenewedForTheRequestedTime) {
  programs_.client({"rig", "lease", "acquire", "--purpose", "x", "--for", "1.5h"});
  const auto left = [&] { return programs_.client_json({"rig", "lease", "show"}); };
  const std::string long_one = left().at("expireTime");
  programs_.client({"rig", "lease", "renew", "--for", "30min"});
  EXPECT_LT(left().at("expireTime").get<std::string>(), long_one);
  expect_error({"rig", "lease", "renew", "--for", "9h"}, 3, {"ttl"});
  expect_error({"rig", "lease", "renew", "--for", "soon"}, 2, {"--for"});
}

TEST_F(RigCli, ArmsHomesAndMoves) {
  const auto one = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--with-lease", "a test"});
    return programs_.client_json(std::move(arguments));
  };
  EXPECT_EQ(one({"rig", "arm"}).at("state"), "UNHOMED");
  EXPECT_EQ(one({"rig", "home"}).at("state"), "IDLE");
  const json rig = one({"rig", "move", "12.5", "--speed", "10"});
  EXPECT_EQ(rig.at("motion").at("outcome"), "DONE");
  EXPECT_NEAR(rig.at("positionMm"), 12.5, kSettled_mm);
  EXPECT_NEAR(programs_.rig.position_mm(), 12.5, kSettled_mm);
  EXPECT_EQ(one({"rig", "disarm"}).at("state"), "DISARMED");
  EXPECT_FALSE(programs_.client_json({"rig", "status"}).contains("lease"))
      << "each command released its lease";
}

TEST_F(RigCli, StatusPrintsTheJsonOfRest) {
  programs_.make_ready(6);
  json shown = programs_.client_json({"rig", "status"});
  json rest = ask(programs_.daemon.http(), "GET", "/v1/rig").json();
  EXPECT_LT(std::stoll(shown.at("revision").get<std::string>()),
            std::stoll(rest.at("revision").get<std::string>()));
  for (json* rig : {&shown, &rest}) {  // these values change all the time
    for (const char* key :
         {"revision", "sampleTime", "linkQuality", "positionMm", "velocityMmPerS"}) {
      EXPECT_EQ(rig->erase(key), 1U) << key;
    }
  }
  EXPECT_EQ(shown, rest);
  EXPECT_EQ(programs_.client_json({"rig", "lease", "show"}),
            ask(programs_.daemon.http(), "GET", "/v1/rig/lease").json());
}

TEST_F(RigCli, StatusTellsHowTheRepliesOfTheDriveArrive) {
  const auto says = [&](const std::string& text) {
    return programs_.client({"rig", "status"}).out.find(text) != std::string::npos;
  };
  EXPECT_TRUE(says("; replies take "));
  EXPECT_FALSE(says("missing replies"));
  programs_.rig.act("fault drop 1");
  EXPECT_TRUE(
      wait_until([&] { return says("; 0 damaged and 1 missing replies, 1 reads repeated"); }));
}

TEST_F(RigCli, RefusalsOfTheRigAreOneLine) {
  programs_.client({"rig", "lease", "acquire", "--purpose", "a test"});
  expect_error({"rig", "home"}, 3, {"arm it"});
  programs_.client({"rig", "arm"});
  expect_error({"rig", "move", "20"}, 3, {"home it first"});
  programs_.client({"rig", "home"});
  expect_error({"rig", "move", "2000"}, 3, {"2000"});
  expect_error({"rig", "move", "20", "--speed", "99"}, 3, {"99"});
  expect_error({"rig", "move"}, 2, {"position"});
  expect_error({"rig", "jog"}, 3, {"--speed"});
  EXPECT_EQ(programs_.rig.speed_mm_per_s(), 0);
}

TEST_F(RigCli, CtrlCDuringAMoveStopsTheAxis) {
  programs_.make_ready(6);
  Process move(programs_.command({"rig", "move", "200", "--speed", "10"}));
  ASSERT_TRUE(programs_.moves());
  ASSERT_TRUE(wait_until([&] { return programs_.rig.position_mm() > 8; }));
  move.signal(SIGINT);
  const auto ended = move.wait();
  EXPECT_EQ(ended.status, 130);
  EXPECT_NE(ended.err.find("the axis was stopped at"), std::string::npos) << ended.err;
  EXPECT_EQ(programs_.rig.speed_mm_per_s(), 0);
  EXPECT_EQ(programs_.state(), "IDLE");
}

TEST_F(RigCli, StopNeedsNoLeaseAndAStoppedMoveDoesNotExitWith0) {
  programs_.make_ready(6);
  Process move(programs_.command({"rig", "move", "200", "--speed", "10"}));
  ASSERT_TRUE(programs_.moves());
  EXPECT_EQ(programs_.client({"rig", "stop"}, "passer-by").status, 0);
  EXPECT_LT(seconds_to_rest(), 0.5);
  const auto ended = move.wait();
  EXPECT_EQ(ended.status, 4);
  EXPECT_NE(ended.err.find("stopped"), std::string::npos) << ended.err;
}

TEST_F(RigCli, AFailedMoveReportsTheReason) {
  programs_.make_ready(6);
  Process move(programs_.command({"rig", "move", "200", "--speed", "10"}));
  ASSERT_TRUE(programs_.moves());
  programs_.rig.act("press stop");
  const auto ended = move.wait();
  EXPECT_EQ(ended.status, 4);
  EXPECT_NE(ended.err.find("stop button"), std::string::npos) << ended.err;
}

constexpr char kPressButton[] = "hydroprint: PRESS THE STOP BUTTON ON THE RIG";

TEST_F(RigCli, AStopThatIsNotObeyedRingsTheBellOnce) {
  programs_.make_ready(6);
  Terminal watch(programs_.command({"rig", "watch"}));
  ASSERT_TRUE(watch.shows("IDLE")) << watch.screen();
  Terminal move(programs_.command({"rig", "move", "200", "--speed", "10"}));
  ASSERT_TRUE(programs_.moves());
  programs_.rig.act("press deaf");
  const auto stop = programs_.client({"rig", "stop"}, "passer-by");
  EXPECT_EQ(stop.status, 4);
  EXPECT_EQ(stop.err.find(kPressButton), 0U) << stop.err;
  EXPECT_EQ(stop.err.find('\a'), std::string::npos) << "this is not a terminal";
  EXPECT_TRUE(move.shows(std::string("\a") + kPressButton)) << move.screen();
  EXPECT_EQ(move.wait(), 4);
  EXPECT_TRUE(move.shows("then reset, arm and home")) << move.screen();
  EXPECT_TRUE(watch.shows(std::string("\a") + kPressButton)) << watch.screen();
  // The drive's watchdog has acted.
  EXPECT_TRUE(watch.shows("FAULT")) << watch.screen();
  EXPECT_EQ(std::count(watch.screen().begin(), watch.screen().end(), '\a'), 1);
  const auto status = programs_.client({"rig", "status"});
  EXPECT_NE(status.out.find("PRESS THE STOP BUTTON ON THE RIG"), std::string::npos) << status.out;
  const auto alarm = status.out.find("alarm 48 communication timeout");
  EXPECT_NE(alarm, std::string::npos) << status.out;
  EXPECT_EQ(status.out.find("alarm 48", alarm + 1), std::string::npos) << status.out;
}

TEST_F(RigCli, CtrlCTellsThatTheStopIsNotObeyed) {
  programs_.make_ready(6);
  Process move(programs_.command({"rig", "move", "200", "--speed", "10"}));
  ASSERT_TRUE(programs_.moves());
  programs_.rig.act("press deaf");
  move.signal(SIGINT);
  const auto ended = move.wait();
  EXPECT_EQ(ended.status, 4);
  EXPECT_EQ(ended.err.find("the axis was stopped"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find(kPressButton), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("then reset, arm and home"), std::string::npos) << ended.err;
}

TEST_F(RigCli, NoWaitReturnsWhileTheAxisMoves) {
  programs_.make_ready(6);
  const json rig = programs_.client_json({"rig", "move", "100", "--no-wait"});
  EXPECT_EQ(rig.at("motion").at("outcome"), "RUNNING");
  EXPECT_TRUE(programs_.moves());
  programs_.client({"rig", "stop"});
}

TEST_F(RigCli, WatchPrintsEveryChange) {
  const TemporaryFolder folder;
  const auto told = folder.path() / "told";
  testing::ProcessOptions options;
  options.files = {{STDOUT_FILENO, told}};
  Process watch(programs_.command({"rig", "watch", "--json"}), options);
  const auto tells = [&](const std::string& state) {
    return wait_until(
        [&] { return content(told).find("\"state\":\"" + state) < std::string::npos; });
  };
  EXPECT_TRUE(tells("DISARMED"));
  EXPECT_EQ(programs_.client({"rig", "lease", "acquire", "--purpose", "a test"}).status, 0);
  EXPECT_EQ(programs_.client({"rig", "arm"}).status, 0);
  EXPECT_TRUE(tells("UNHOMED"));
  EXPECT_EQ(programs_.client({"rig", "home"}).status, 0);
  EXPECT_TRUE(tells("MOVING"));
  EXPECT_TRUE(tells("IDLE"));
  watch.signal(SIGINT);
  EXPECT_EQ(watch.wait().status, 130);
}

TEST_F(RigCli, AJogForATimeCoversItsDistance) {
  programs_.make_ready(6);
  const double begin_mm = programs_.rig.position_mm();
  EXPECT_EQ(programs_.client({"rig", "jog", "--speed", "5", "--for", "1s"}).status, 0);
  EXPECT_EQ(programs_.rig.speed_mm_per_s(), 0);
  // After the stop, the axis moves on during one exchange of messages with the drive and its ramp.
  EXPECT_NEAR(programs_.rig.position_mm() - begin_mm, 5, 1);
}

TEST_F(RigCli, AKilledJogIsAtRestWithinHalfASecond) {
  programs_.make_ready(6);
  for (int i = 0; i < 3; ++i) {
    Process jog(programs_.command({"rig", "jog", "--speed", "5", "--for", "30s"}));
    ASSERT_TRUE(programs_.moves());
    std::this_thread::sleep_for(330ms + i * 37ms);
    jog.signal(SIGKILL);
    EXPECT_LT(seconds_to_rest(), 0.5);
  }
}

TEST_F(RigCli, AJogEndsWithTheLease) {
  programs_.make_ready(6);
  Process jog(programs_.command({"rig", "jog", "--speed", "5", "--for", "30s"}));
  ASSERT_TRUE(programs_.moves());
  programs_.client({"rig", "lease", "break", "--reason", "a test"}, "alice");
  EXPECT_LT(seconds_to_rest(), 0.5);
  // LEASE_REQUIRED, or MOTION_IN_PROGRESS for a request that was on its way when the stop came.
  const int status = jog.wait().status;
  EXPECT_TRUE(status == 3 || status == 4) << status;
}

TEST_F(RigCli, AHeldKeyMovesTheAxisAndReleasingItStopsTheAxis) {
  programs_.make_ready(6);
  Terminal jog(programs_.command({"rig", "jog", "--speed", "5"}));
  ASSERT_TRUE(jog.shows("IDLE")) << jog.screen();
  EXPECT_FALSE(jog.is_cooked());
  const double begin_mm = programs_.rig.position_mm();
  jog.hold("j", 1000ms);
  EXPECT_GT(programs_.rig.speed_mm_per_s(), 0);
  EXPECT_GT(programs_.rig.position_mm(), begin_mm + 3);
  EXPECT_LT(seconds_to_rest(), 0.5);
  const double low_mm = programs_.rig.position_mm();
  jog.hold("\x1b[A", 600ms);
  jog.type(" ");
  EXPECT_LT(seconds_to_rest(), 0.3);
  EXPECT_LT(programs_.rig.position_mm(), low_mm - 1);
  jog.type("q");
  EXPECT_EQ(jog.wait(), 0) << jog.screen();
  EXPECT_TRUE(jog.is_cooked());
}

TEST_F(RigCli, ATapIsAShortStep) {
  programs_.make_ready(6);
  Terminal jog(programs_.command({"rig", "jog", "--speed", "5"}));
  ASSERT_TRUE(jog.shows("IDLE")) << jog.screen();
  const double begin_mm = programs_.rig.position_mm();
  jog.type("j");
  ASSERT_TRUE(programs_.moves());
  ASSERT_TRUE(programs_.rests());
  EXPECT_GT(programs_.rig.position_mm(), begin_mm + 0.2);
  EXPECT_LT(programs_.rig.position_mm(), begin_mm + 2.5);
}

TEST_F(RigCli, TheTerminalIsRestoredAfterEveryJog) {
  programs_.make_ready(6);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Terminal jog(programs_.command({"rig", "jog", "--speed", "5"}));
    ASSERT_TRUE(jog.shows("IDLE")) << jog.screen();
    jog.hold("j", 300ms);
    ::kill(jog.pid(), signal);
    EXPECT_EQ(jog.wait(), signal == SIGHUP ? 128 + SIGHUP : 130);
    EXPECT_TRUE(jog.is_cooked()) << signal;
    EXPECT_LT(seconds_to_rest(), 0.5);
  }
}

TEST_F(RigCli, CtrlCOnATerminalStopsHoming) {
  programs_.make_ready(30);
  Terminal home(programs_.command({"rig", "home"}));
  ASSERT_TRUE(home.shows("MOVING")) << home.screen();
  home.type("\x03");
  EXPECT_EQ(home.wait(), 130);
  EXPECT_EQ(programs_.rig.speed_mm_per_s(), 0);
}

TEST_F(RigCli, ThePythonExamplePrintsTheStateAndStops) {
  programs_.make_ready(6);
  programs_.client({"rig", "move", "200", "--no-wait"});
  const auto ended = hydroprint::testing::run(
      {"/usr/bin/env", "PYTHONPATH=" + testing::build_path("python"), "PYTHONDONTWRITEBYTECODE=1",
       "/usr/bin/python3", testing::source_path("client/python/rig.py"), "--stop", "--server",
       programs_.daemon.address()});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("lease: tester (a test)"), std::string::npos) << ended.out;
  EXPECT_TRUE(programs_.rests());
}

}  // namespace
}  // namespace hydroprint::tests
