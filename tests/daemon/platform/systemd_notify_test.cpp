// Messages to systemd. The test provides the socket in place of systemd.
#include "daemon/platform/systemd_notify.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/support/timing.h"

namespace hydroprint::daemon {
namespace {

using hydroprint::testing::TemporaryFolder;
using hydroprint::testing::wait_until;

constexpr int kPatience_s = 60;

/// Replaces systemd: the socket of NOTIFY_SOCKET, and a watchdog of 80 ms.
class ServiceManager : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string path = folder_.path() / "notify";
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    ASSERT_LT(path.size(), sizeof address.sun_path);
    std::memcpy(address.sun_path, path.c_str(), path.size());
    socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ASSERT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    const timeval limit{kPatience_s, 0};
    ASSERT_EQ(::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit), 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
    ::setenv("WATCHDOG_USEC", "80000", 1);
    ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
  }
  void TearDown() override {
    for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) ::unsetenv(name);
    ::close(socket_);
  }
  /// The next message; empty if none arrives within kPatience_s.
  std::string messages(int flags = 0) {
    std::array<char, 512> bytes{};
    const ssize_t got = ::recv(socket_, bytes.data(), bytes.size(), flags);
    return got < 0 ? "" : std::string(bytes.data(), static_cast<std::size_t>(got));
  }

 private:
  TemporaryFolder folder_;
  int socket_ = -1;
};

TEST_F(ServiceManager, IsNotifiedOfReadyAndStopping) {
  notify_ready("serving 127.0.0.1:50051");
  EXPECT_EQ(messages(), "READY=1\nSTATUS=serving 127.0.0.1:50051");
  notify_stopping();
  EXPECT_TRUE(messages().starts_with("STOPPING=1"));
}

TEST_F(ServiceManager, WatchdogIsFedWhileTheLoopRuns) {
  std::atomic<std::uint64_t> rounds = 0;
  const WatchdogFeeder feeder([&] { return std::optional(++rounds); });
  for (int i = 0; i < 5; ++i) EXPECT_EQ(messages(), "WATCHDOG=1");
}

TEST_F(ServiceManager, WatchdogIsFedWithoutADrive) {
  const WatchdogFeeder feeder([] { return std::nullopt; });
  for (int i = 0; i < 5; ++i) EXPECT_EQ(messages(), "WATCHDOG=1");
}

TEST_F(ServiceManager, WatchdogIsNotFedWhenTheLoopHangs) {
  std::atomic<int> looks = 0;
  const WatchdogFeeder feeder([&] {
    ++looks;
    return std::optional<std::uint64_t>(7);
  });
  EXPECT_EQ(messages(), "WATCHDOG=1") << "the first look cannot show whether the loop hangs";
  ASSERT_TRUE(wait_until([&] { return looks >= 10; }, kPatience_s));
  EXPECT_EQ(messages(MSG_DONTWAIT), "");
}

TEST_F(ServiceManager, NothingIsSentWithoutAWatchdog) {
  ::unsetenv("WATCHDOG_USEC");
  std::atomic<int> looks = 0;
  {
    const WatchdogFeeder feeder([&] {
      ++looks;
      return std::optional<std::uint64_t>(looks);
    });
  }
  EXPECT_EQ(looks, 0);
  EXPECT_EQ(messages(MSG_DONTWAIT), "");
}

}  // namespace
}  // namespace hydroprint::daemon
