// What a program that hydroprint-confine starts may do.
#include <signal.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "tests/daemon/confine/confine_fixture.h"
#include "tests/support/content.h"

namespace hydroprint::testing {
namespace {

TEST_F(Confine, ReadsInputsAndWritesWorkOnly) {
  if (!kernel_has_landlock()) GTEST_SKIP() << "this kernel has no Landlock";
  const std::string secret = folder.write("secret", "s");
  (void)std::ofstream(inputs + "/model.obj").put('m');
  (void)std::ofstream(work + "/spec.json").put('{');
  EXPECT_EQ(
      probe({"read", inputs + "/model.obj", "read", work + "/spec.json", "read", "/etc/passwd",
             "list", inputs, "write", work + "/film.png", "move", work + "/film.png"}),
      "read: yes\nread: yes\nread: yes\nlist: yes\nwrite: yes\nmove: yes\n");
  std::filesystem::create_symlink(secret, inputs + "/link");
  const std::string refused = strerrordesc_np(EACCES), outside = folder.path();
  EXPECT_EQ(probe({"read", secret, "read", inputs + "/link", "read", inputs + "/../secret", "list",
                   outside}),
            "read: " + refused + "\nread: " + refused + "\nread: " + refused +
                "\nlist: " + refused + "\n");
  EXPECT_EQ(probe({"write", secret, "write", outside + "/new", "write", inputs + "/model.obj",
                   "write", inputs + "/new", "move", secret, "truncate", secret}),
            "write: " + refused + "\nwrite: " + refused + "\nwrite: " + refused +
                "\nwrite: " + refused + "\nmove: " + refused + "\ntruncate: " + refused + "\n");
  EXPECT_EQ(content(secret), "s");
}

TEST_F(Confine, HasNoNetwork) {
  const std::string refused = strerrordesc_np(EACCES);
  EXPECT_EQ(probe({"socket", "x"}), "inet: " + refused + "\nunix: " + refused +
                                        "\nnetlink: " + refused + "\nio_uring: " + refused + "\n");
}

TEST_F(Confine, SignalsItsOwnThreads) {
  EXPECT_EQ(probe({"self", "x"}),
            "tgkill own thread: yes\nqueue to own thread: yes\nraise: yes\nsignals arrive: yes\n");
}

TEST_F(Confine, CannotSignalOtherProcessesOrReadTheirLimits) {
  const std::string refused = ": " + std::string(strerrordesc_np(EACCES)) + "\n";
  const Process other({"/bin/sleep", "60"});
  for (const pid_t id : {::getpid(), other.pid()}) {
    EXPECT_EQ(probe({"signal", std::to_string(id)}),
              "kill" + refused + "tkill" + refused + "tgkill" + refused + "tgkill by long id" +
                  refused + "queue" + refused + "queue to thread" + refused + "pidfd" + refused +
                  "group" + refused);
    EXPECT_EQ(probe({"limits", std::to_string(id)}), "read limits" + refused + "own limits: yes\n");
  }
}

// AddressSanitizer reserves far more memory than any limit, so the test is skipped with it.
#ifndef __SANITIZE_ADDRESS__
TEST_F(Confine, MemoryIsLimited) {
  EXPECT_EQ(probe({"grow", "64"}), "grow: yes\n");
  EXPECT_EQ(probe({"grow", "800"}), std::string("grow: ") + strerrordesc_np(ENOMEM) + "\n");
  const Ended unlimited = confine({"--inputs", inputs, "--work", work, "--memory-mib", "unlimited",
                                   "--", program_path("daemon_confine_probe"), "grow", "800"});
  EXPECT_EQ(unlimited.out, "grow: yes\n");
}
#endif

TEST_F(Confine, FileSizeIsLimited) {
  const Words command{"/bin/dd", "if=/dev/zero", "of=" + work + "/huge",
                      "bs=1M",   "count=3",      "status=none"};
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
