// What a program that hydroprint-confine starts may do.
#include <signal.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "tests/daemon/confine/confine_fixture.h"
#include "tests/support/content.h"

namespace hydroprint::testing {
namespace {

const std::string kRefused = strerrordesc_np(EPERM);

/// Expects each line of the probe to end with this outcome, and returns the number of lines.
int expect_outcomes(const std::string& lines, const std::string& outcome) {
  int count = 0;
  std::istringstream all(lines);
  for (std::string line; std::getline(all, line); ++count) {
    EXPECT_TRUE(line.ends_with(": " + outcome)) << line;
  }
  return count;
}

TEST_F(Confine, ReadsInputsAndWritesWorkOnly) {
  if (!kernel_has_landlock()) GTEST_SKIP() << "this kernel has no Landlock";
  const std::string secret = folder.write("secret", "s");
  (void)std::ofstream(inputs + "/model.obj").put('m');
  (void)std::ofstream(work + "/spec.json").put('{');
  EXPECT_EQ(probe({"read", inputs + "/model.obj", "read", work + "/spec.json", "read",
                   "/etc/passwd", "read", "/dev/urandom", "list", inputs, "write",
                   work + "/film.png", "move", work + "/film.png"}),
            "read: yes\nread: yes\nread: yes\nread: yes\nlist: yes\nwrite: yes\nmove: yes\n");
  std::filesystem::create_symlink(secret, inputs + "/link");
  const std::string refused = strerrordesc_np(EACCES), outside = folder.path();
  EXPECT_EQ(probe({"read", secret, "read", inputs + "/link", "read", inputs + "/../secret", "list",
                   outside, "list", "/dev"}),
            "read: " + refused + "\nread: " + refused + "\nread: " + refused +
                "\nlist: " + refused + "\nlist: " + refused + "\n");
  EXPECT_EQ(probe({"write", secret, "write", outside + "/new", "write", inputs + "/model.obj",
                   "write", inputs + "/new", "move", secret, "truncate", secret}),
            "write: " + refused + "\nwrite: " + refused + "\nwrite: " + refused +
                "\nwrite: " + refused + "\nmove: " + refused + "\ntruncate: " + kRefused + "\n");
  EXPECT_EQ(content(secret), "s");
}

// Inputs are hard links to the files of the store.
TEST_F(Confine, CannotEmptyItsInputs) {
  const std::string input = inputs + "/model.obj";
  (void)std::ofstream(input).put('m');
  EXPECT_EQ(expect_outcomes(probe({"empty", input}), kRefused), 3);
  EXPECT_EQ(content(input), "m");
}

TEST_F(Confine, HasNoNetwork) { EXPECT_EQ(expect_outcomes(probe({"socket", "x"}), kRefused), 4); }

TEST_F(Confine, CallsThatCouldHarmOthersAreRefused) {
  EXPECT_GT(expect_outcomes(probe({"refused", work + "/file"}), kRefused), 80);
}

TEST_F(Confine, CallsThatAFilterCannotJudgeAreMissing) {
  const std::string missing = strerrordesc_np(ENOSYS), unsupported = strerrordesc_np(EOPNOTSUPP);
  EXPECT_EQ(probe({"missing", work + "/file"}),
            "clone3: " + missing + "\nopenat2: " + missing + "\nfchmodat2: " + missing +
                "\nsetxattrat: " + missing + "\nfallocate: " + unsupported + "\n");
}

TEST_F(Confine, ThreadsMemoryTimersAndFilesWork) {
  EXPECT_GT(expect_outcomes(probe({"needed", work}), "yes"), 20);
}

// A kernel without the interface i386 ends the program by SIGSEGV.
TEST_F(Confine, OtherBinaryInterfacesAreRefused) {
  const std::string program = program_path("daemon_confine_probe");
  EXPECT_EQ(run_confined({program, "interface", "x32"}).signal, SIGSYS);
#ifdef __x86_64__
  const int signal = run_confined({program, "interface", "i386"}).signal;
  EXPECT_TRUE(signal == SIGSYS || signal == SIGSEGV) << signal;
#endif
}

TEST_F(Confine, SignalsItsOwnThreads) {
  EXPECT_EQ(probe({"self", "x"}),
            "tgkill own thread: yes\nqueue to own thread: yes\nraise: yes\nsignals arrive: yes\n");
}

TEST_F(Confine, CannotSignalOtherProcessesOrReadTheirLimits) {
  const Process other({"/bin/sleep", "60"});
  for (const pid_t id : {::getpid(), other.pid()}) {
    EXPECT_EQ(expect_outcomes(probe({"signal", std::to_string(id)}), kRefused), 8);
    EXPECT_EQ(probe({"limits", std::to_string(id)}),
              "read limits: " + kRefused + "\nown limits: yes\n");
  }
}

// AddressSanitizer reserves far more memory than any limit, so the test is skipped with it.
#ifndef __SANITIZE_ADDRESS__
TEST_F(Confine, MemoryIsLimited) {
  EXPECT_EQ(probe({"grow", "64"}), "grow: yes\n");
  EXPECT_EQ(probe({"grow", "800"}), std::string("grow: ") + strerrordesc_np(ENOMEM) + "\n");
  const Ended unlimited =
      confine({"--inputs", inputs, "--work", work, "--memory-mib", "unlimited", kAllow, "--",
               program_path("daemon_confine_probe"), "grow", "800"});
  EXPECT_EQ(unlimited.out, "grow: yes\n");
}
#endif

TEST_F(Confine, FileSizeIsLimited) {
  const Words command{"/bin/dd", "if=/dev/urandom", "of=" + work + "/huge",
                      "bs=1M",   "count=3",         "status=none"};
  EXPECT_EQ(run_confined(command, {"--file-mib", "3"}).status, 0);
  EXPECT_EQ(run_confined(command, {"--file-mib", "2"}).signal, SIGXFSZ);
  EXPECT_EQ(std::filesystem::file_size(work + "/huge"), 2 << 20);
}

TEST_F(Confine, ProcessorTimeIsLimited) {
  const Ended ended = run_confined({"/bin/sh", "-c", "while :; do :; done"}, {"--cpu-s", "1"});
  EXPECT_EQ(ended.signal, SIGXCPU);
}

TEST_F(Confine, HasNoNewPrivilegesAndNoRealTimePriority) {
  const std::string status = run_confined({"/bin/cat", "/proc/self/status"}).out;
  EXPECT_NE(status.find("NoNewPrivs:\t1"), std::string::npos) << status;
  EXPECT_NE(status.find("Seccomp:\t2"), std::string::npos) << status;
  const std::string limits = run_confined({"/bin/cat", "/proc/self/limits"}).out;
  EXPECT_NE(limits.find("Max realtime priority     0                    0"), std::string::npos)
      << limits;
}

}  // namespace
}  // namespace hydroprint::testing
