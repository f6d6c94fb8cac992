// The programs that the daemon starts: priority, rights, pipes.
#include "daemon/workers/child_process.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <thread>

#include "tests/daemon/confine/kernel_without.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon {
namespace {

using hydroprint::testing::KernelWithout;
using hydroprint::testing::program_path;
using hydroprint::testing::TemporaryFolder;

constexpr std::chrono::seconds kPatience{60};

/// Starts a program in a folder.
ChildProcess started(Launch launch_plan, const TemporaryFolder& folder) {
  launch_plan.inputs = launch_plan.work = folder.path();
  launch_plan.limits = {
      .cpu_s = 10, .file_bytes = 1 << 20, .needs_landlock = confine::landlock_version() > 0};
  if (launch_plan.confine_program.empty()) {
    launch_plan.confine_program = program_path("hydroprint-confine");
  }
  auto child = launch(launch_plan);
  if (!child) throw std::runtime_error(child.error().message);
  return std::move(*child);
}

/// Runs a program with arguments and returns what it printed. Expects it to succeed.
std::string output_of(const Launch& launch_plan, const TemporaryFolder& folder) {
  const ChildProcess child = started(launch_plan, folder);
  const auto status = wait_for_end(child, kPatience);
  std::string printed, errors;
  (void)drain(child.answer, printed, 1 << 16);
  (void)drain(child.errors, errors, 1 << 16);
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

/// Expects a program to end with status 127, and returns its message.
std::string refusal(const Launch& launch_plan) {
  const TemporaryFolder folder;
  const ChildProcess child = started(launch_plan, folder);
  const auto status = wait_for_end(child, kPatience);
  EXPECT_TRUE(status && WIFEXITED(*status) && WEXITSTATUS(*status) == 127);
  std::string words;
  (void)drain(child.errors, words, 1 << 16);
  return words;
}

TEST(ChildProcess, RunsInItsInputFolderWithLimitsAndFilter) {
  const TemporaryFolder folder;
  EXPECT_EQ(output_of({.program = "/bin/pwd"}, folder), folder.path().string() + "\n");
  const std::string status =
      output_of({.program = "/usr/bin/cat", .arguments = {"/proc/self/status"}}, folder);
  EXPECT_NE(status.find("NoNewPrivs:\t1"), std::string::npos) << status;
  EXPECT_NE(status.find("Seccomp:\t2"), std::string::npos) << status;
  const std::string limits =
      output_of({.program = "/bin/sh", .arguments = {"-c", "ulimit -t; ulimit -f"}}, folder);
  EXPECT_EQ(limits, "10\n2048\n") << "seconds, and 1 MiB in blocks of 512 bytes";
}

TEST(ChildProcess, HasTheProcessIdOfItsHandleAndLeadsItsGroup) {
  const TemporaryFolder folder;
  const ChildProcess child = started(
      {.program = "/bin/sh",
       .arguments =
           {"-c",
            "echo $$; read -r id name state parent group rest </proc/self/stat; echo $group >&3"}},
      folder);
  const auto status = wait_for_end(child, kPatience);
  EXPECT_EQ(status, 0);
  std::string id, group;
  (void)drain(child.answer, id, 100);
  (void)drain(child.progress, group, 100);
  EXPECT_EQ(std::stoi(id), child.pid);
  EXPECT_EQ(std::stoi(group), child.pid);
}

TEST(ChildProcess, AnswersRequests) {
  const TemporaryFolder folder;
  ChildProcess child = started({.program = "/usr/bin/cat", .is_asked = true}, folder);
  ASSERT_EQ(::write(child.requests.get(), "a request\n", 10), 10);
  child.requests.reset();
  EXPECT_EQ(wait_for_end(child, kPatience), 0);
  std::string answer;
  (void)drain(child.answer, answer, 100);
  EXPECT_EQ(answer, "a request\n");
}

TEST(ChildProcess, ProgramThatCannotBeRunIsNamed) {
  const std::string words =
      "the worker cannot be started: /no/such/program: " + std::string(strerrordesc_np(ENOENT)) +
      "\n";
  const Launch confined{.program = "/no/such/program"};
  EXPECT_EQ(refusal(confined), words);
  Launch camera = confined;
  camera.confined = false;
  EXPECT_EQ(refusal(camera), words);
  EXPECT_EQ(refusal({.program = "/bin/true", .confine_program = "/no/such/program"}), words);
}

// A worker that was started without hydroprint-confine would be unconfined.
TEST(ChildProcess, DoesNotRunWithoutItsConfinement) {
  const TemporaryFolder folder;
  const auto child = launch({.program = "/usr/bin/touch",
                             .arguments = {folder.path() / "touched"},
                             .inputs = folder.path(),
                             .work = folder.path()});
  ASSERT_TRUE(child);
  const auto status = wait_for_end(*child, kPatience);
  EXPECT_TRUE(status && WIFEXITED(*status) && WEXITSTATUS(*status) == 127);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "touched"));
}

// exec, first of hydroprint-confine and then of the worker, must not cancel that.
TEST(ChildProcess, IsKilledWhenItsThreadEnds) {
  const TemporaryFolder folder;
  ChildProcess child;
  std::thread([&] {
    child =
        started({.program = "/bin/sh", .arguments = {"-c", "echo >&3; exec sleep 600"}}, folder);
    pollfd has_started{child.progress.get(), POLLIN, 0};
    ::poll(&has_started, 1, -1);
  }).join();
  const auto status = wait_for_end(child, kPatience);
  EXPECT_TRUE(status && WIFSIGNALED(*status) && WTERMSIG(*status) == SIGKILL);
}

TEST(ChildProcess, ConfinementIsChecked) {
  const std::string confine_program = program_path("hydroprint-confine");
  const auto check = [](const std::filesystem::path& program) {
    return check_confinement(program, /*needs_landlock=*/false);
  };
  const auto checked = check(confine_program);
  ASSERT_TRUE(checked) << checked.error().message;
  EXPECT_EQ(checked->empty(), confine::landlock_version() > 0) << *checked;
  const auto expect_words = [](const Result<std::string>& status, const std::string& words) {
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, Code::kFailedPrecondition);
    EXPECT_NE(status.error().message.find(words), std::string::npos) << status.error().message;
    EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
  };
  expect_words(check("/no/such/program"), "/no/such/program");
  expect_words(check("/bin/false"), "/bin/false");
  const KernelWithout seccomp({SYS_seccomp}, EPERM, /*also_prctl=*/true);
  expect_words(*seccomp.call([&] { return std::optional(check(confine_program)); }),
               "this machine cannot confine workers");
  const KernelWithout landlock({SYS_landlock_create_ruleset}, ENOSYS);
  expect_words(
      *landlock.call([&] { return std::optional(check_confinement(confine_program, true)); }),
      "workers.allow_without_landlock");
  const auto allowed = *landlock.call([&] { return std::optional(check(confine_program)); });
  ASSERT_TRUE(allowed) << allowed.error().message;
  EXPECT_NE(allowed->find("every file"), std::string::npos) << *allowed;
}

TEST(ChildProcess, PassesOnWhetherLandlockIsNeeded) {
  Launch program{.program = "/bin/true", .confine_program = "/confine"};
  const auto flags = [&] {
    const std::vector<std::string> words = command_of(program);
    return std::count(words.begin(), words.end(), "--allow-without-landlock");
  };
  EXPECT_EQ(flags(), 0);
  program.limits.needs_landlock = false;
  EXPECT_EQ(flags(), 1);
}

}  // namespace
}  // namespace hydroprint::daemon
