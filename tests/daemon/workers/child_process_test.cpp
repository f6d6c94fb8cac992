// Priority of the programs that the daemon starts.
#include "daemon/workers/child_process.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>

#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon {
namespace {

using hydroprint::testing::TemporaryFolder;

/// Runs a program with arguments and returns what it printed. Expects it to succeed.
std::string output_of(Launch launch_plan, const TemporaryFolder& folder) {
  launch_plan.inputs = launch_plan.work = folder.path();
  launch_plan.limits = {.cpu_s = 10, .file_bytes = 1 << 20};
  const auto sandbox = Sandbox::make();
  if (!sandbox) throw std::runtime_error(sandbox.error().message);
  const auto child = launch(launch_plan, *sandbox);
  if (!child) throw std::runtime_error(child.error().message);
  const auto status = wait_for_end(*child, std::chrono::seconds(60));
  std::string printed, errors;
  (void)drain(child->answer, printed, 1 << 16);
  (void)drain(child->errors, errors, 1 << 16);
  EXPECT_TRUE(status && WIFEXITED(*status) && WEXITSTATUS(*status) == 0) << errors;
  return printed;
}

/// The nice value of a program with this Launch::niceness.
int niceness_of(const Launch& launch_plan) {
  const TemporaryFolder folder;
  return std::stoi(output_of(launch_plan, folder));
}

TEST(ChildProcess, HasTheNiceValueOfItsKind) {
  const int own = ::getpriority(PRIO_PROCESS, 0);
  Launch worker{.program = "/usr/bin/nice"};
  EXPECT_EQ(niceness_of(worker), std::max(10, own));
  Launch camera = worker;
  camera.confined = false;
  camera.niceness = kCameraNiceness;
  EXPECT_EQ(niceness_of(camera), std::max(kCameraNiceness, own));
}

TEST(ChildProcess, HasNoRightToRealTimeScheduling) {
  const TemporaryFolder folder;
  for (const bool confined : {true, false}) {
    const std::string limits = output_of(
        {.program = "/usr/bin/cat", .arguments = {"/proc/self/limits"}, .confined = confined},
        folder);
    for (const char* name : {"Max realtime priority", "Max nice priority"}) {
      const auto row = limits.find(name);
      ASSERT_NE(row, std::string::npos) << limits;
      EXPECT_EQ(std::stoi(limits.substr(row + std::string_view("Max realtime priority").size())),
                0);
    }
  }
}

}  // namespace
}  // namespace hydroprint::daemon
