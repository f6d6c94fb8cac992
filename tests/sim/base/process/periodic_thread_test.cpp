#include "sim/base/process/periodic_thread.h"

#include <gtest/gtest.h>

#include <atomic>

namespace hydroprint {
namespace {

using namespace std::chrono_literals;

TEST(PeriodicThread, CallsItsTaskAtOnceAndAgain) {
  std::atomic<int> calls = 0;
  const PeriodicThread thread(1ms, [&] {
    ++calls;
    calls.notify_all();
  });
  calls.wait(0);
  calls.wait(1);
  EXPECT_GE(calls, 2);
}

TEST(PeriodicThread, EndsWithoutWaitingForItsPeriod) {
  std::atomic<int> calls = 0;
  {
    const PeriodicThread thread(1h, [&] {
      ++calls;
      calls.notify_all();
    });
    calls.wait(0);
  }
  EXPECT_EQ(calls, 1);
}

TEST(PeriodicThread, WaitsForTheCallInProgress) {
  std::atomic<bool> started = false, finished = false;
  {
    const PeriodicThread thread(1ms, [&] {
      started = true;
      started.notify_all();
      std::this_thread::sleep_for(20ms);
      finished = true;
    });
    started.wait(false);
  }
  EXPECT_TRUE(finished);
}

}  // namespace
}  // namespace hydroprint
