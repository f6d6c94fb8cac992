// Runs the script that checks a node with the real shell, without Slurm.
#include "daemon/workers/slurm/node_check.h"

#include <gtest/gtest.h>

#include <ctime>
#include <fstream>

#include "tests/support/content.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon::slurm {
namespace {

using Verdict = CheckLine::Verdict;

class NodeCheckScript : public ::testing::Test {
 protected:
  NodeCheckScript() {
    std::filesystem::create_directories(shared);
    std::ofstream(token_file(shared)) << "shared\n";
    program(required.worker, "echo '{\"version\": \"1\", \"build_id\": \"ab12\"}'");
    program(required.confine_program, "[ \"$1\" = --check ]");
  }
  static void program(const std::filesystem::path& path, const std::string& commands) {
    std::ofstream(path) << "#!/bin/sh\n" << commands << "\n";
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }
  // Returns the exit status.
  [[nodiscard]] int run() const {
    const auto script = folder.path() / "script";
    std::ofstream(script) << node_check_script(required, shared, {"--time=1"});
    return hydroprint::testing::run({"/bin/sh", script, "node-1"}).status;
  }
  [[nodiscard]] CheckLine line() const {
    const std::int64_t asked_s = std::time(nullptr);
    EXPECT_EQ(run(), 0);
    const auto findings =
        parse_findings(hydroprint::testing::content(findings_file(shared, "node-1")));
    if (!findings) return {Verdict::kFault, "", "malformed findings"};
    return judge_node("node-1", *findings, required, asked_s, std::time(nullptr));
  }

  hydroprint::testing::TemporaryFolder folder;
  std::filesystem::path shared = folder.path() / "it's shared $(touch x)";
  NodeRequirements required{folder.path() / "the worker's program", "ab12",
                            folder.path() / "confine it"};
};

TEST_F(NodeCheckScript, NodeWithEverythingIsOk) {
  const CheckLine found = line();
  EXPECT_EQ(found.verdict, Verdict::kOk) << found.detail;
  EXPECT_EQ(found.what, "node node-1");
}

TEST_F(NodeCheckScript, FolderWithoutTheTokenIsNotTheSharedOne) {
  std::filesystem::remove(token_file(shared));
  EXPECT_NE(run(), 0);
  EXPECT_TRUE(std::filesystem::is_empty(shared));
}

TEST_F(NodeCheckScript, FolderThatIsMissingIsNotTheSharedOne) {
  std::filesystem::remove_all(shared);
  EXPECT_NE(run(), 0);
  EXPECT_FALSE(std::filesystem::exists(shared));
}

TEST_F(NodeCheckScript, OtherBuildIsAFaultWithBothIds) {
  program(required.worker, "echo '{\"version\": \"1\", \"build_id\": \"cd34\"}'");
  const CheckLine found = line();
  EXPECT_EQ(found.verdict, Verdict::kFault);
  for (const char* id : {"build cd34", "build ab12"}) {
    EXPECT_NE(found.detail.find(id), std::string::npos) << found.detail;
  }
}

TEST_F(NodeCheckScript, WorkerThatPrintsNoBuildIdDiffers) {
  program(required.worker, "exit 3");
  EXPECT_NE(line().detail.find("build unknown"), std::string::npos);
}

TEST_F(NodeCheckScript, MissingWorkerIsAFaultWithItsPath) {
  std::filesystem::remove(required.worker);
  const CheckLine found = line();
  EXPECT_EQ(found.verdict, Verdict::kFault);
  EXPECT_EQ(found.detail.find(required.worker.string() + ": the worker is missing"), 0U)
      << found.detail;
}

TEST_F(NodeCheckScript, NodeThatCannotConfineIsAFaultWithItsWords) {
  program(required.confine_program, "echo first >&2; echo 'no seccomp here' >&2; exit 4");
  const CheckLine found = line();
  EXPECT_EQ(found.verdict, Verdict::kFault);
  EXPECT_EQ(found.detail, "cannot confine workers: no seccomp here");
  std::filesystem::remove(required.confine_program);
  EXPECT_EQ(line().verdict, Verdict::kFault);
}

TEST_F(NodeCheckScript, NodeWithoutLandlockIsANoteIfItIsAllowed) {
  program(required.confine_program,
          "[ \"$2\" = --allow-without-landlock ] && echo 'without Landlock' >&2");
  EXPECT_EQ(line().verdict, Verdict::kFault);
  required.needs_landlock = false;
  const CheckLine found = line();
  EXPECT_EQ(found.verdict, Verdict::kNote);
  EXPECT_EQ(found.detail, "without Landlock");
}

TEST(NodeCheck, FindingsThatAreNotCompleteAreIgnored) {
  EXPECT_FALSE(parse_findings(""));
  EXPECT_FALSE(parse_findings("clock_s 1800000000\nhas_worker\nbuild_id ab\n"));
  EXPECT_FALSE(parse_findings("clock_s soon\nend\n"));
  EXPECT_TRUE(parse_findings("clock_s 1800000000\nhas_worker\nbuild_id ab\nend\n"));
}

TEST(NodeCheck, ClockThatDiffersByMoreThanAMinuteIsANote) {
  const NodeRequirements required{"/worker", "ab", "/confine"};
  const auto line = [&](std::int64_t clock_s) {
    return judge_node("n1", {clock_s, true, "ab", ""}, required, 100'000, 100'030);
  };
  for (const std::int64_t clock_s : {100'000 - 60, 100'000, 100'015, 100'030 + 60}) {
    EXPECT_EQ(line(clock_s).verdict, Verdict::kOk) << clock_s;
  }
  EXPECT_EQ(line(100'030 + 3600).verdict, Verdict::kNote);
  EXPECT_NE(line(100'030 + 3600).detail.find("3600 s fast"), std::string::npos);
  EXPECT_NE(line(100'000 - 61).detail.find("61 s slow"), std::string::npos);
}

TEST(NodeCheck, BuildOfANodeIsNotJudgedWithoutAWorkerHere) {
  const CheckLine line = judge_node("n1", {100, true, "ab", ""}, {"/worker", "", "/c"}, 100, 100);
  EXPECT_EQ(line.verdict, Verdict::kOk);
}

TEST(NodeList, NodesOfTheDefaultPartitionAreKept) {
  const auto nodes =
      parse_node_list("n1|main*|idle\nn2|main*|down*\nn1|night|idle\nn3|night|mixed\n", "");
  ASSERT_TRUE(nodes);
  EXPECT_EQ(*nodes, (std::vector<Node>{{"n1", "idle"}, {"n2", "down*"}}));
}

TEST(NodeList, NodeOfTwoNamedPartitionsIsListedOnce) {
  const auto nodes = parse_node_list("n1|main*|idle\nn1|night|idle\n", "main,night");
  ASSERT_TRUE(nodes);
  EXPECT_EQ(*nodes, (std::vector<Node>{{"n1", "idle"}}));
}

TEST(NodeList, AnythingElseIsRefused) {
  EXPECT_FALSE(parse_node_list("n1|main*\n", ""));
  EXPECT_FALSE(parse_node_list("../x|main*|idle\n", ""));
  EXPECT_FALSE(parse_node_list("sinfo: error\n", ""));
}

TEST(NodeList, NodesThatAreDownOrDoNotRespondAreNotAvailable) {
  for (const char* state : {"idle", "mixed", "allocated", "completing", "idle~"}) {
    EXPECT_TRUE(is_available({"n1", state})) << state;
  }
  for (const char* state : {"down", "down*", "drained", "draining", "failing", "idle*"}) {
    EXPECT_FALSE(is_available({"n1", state})) << state;
  }
}

}  // namespace
}  // namespace hydroprint::daemon::slurm
