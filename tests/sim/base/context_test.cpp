#include "sim/base/context.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <string>
#include <vector>

namespace hydroprint {
namespace {

Context with_threads(int threads) {
  Context context;
  context.threads = threads;
  return context;
}

TEST(ParallelFor, CallsEachIndexOnce) {
  for (const int threads : {-1, 0, 1, 2, 7}) {
    for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
      std::vector<std::atomic<int>> calls(count);
      ASSERT_TRUE(parallel_for(with_threads(threads), "x", count, [&](std::size_t i) -> Status {
        ++calls[i];
        return {};
      }));
      for (const auto& c : calls) EXPECT_EQ(c, 1);
    }
  }
}

TEST(ParallelFor, GivesTheSameNumbersForAnyNumberOfThreads) {
  const auto run = [](int threads) {
    std::vector<double> result(500);
    EXPECT_TRUE(
        parallel_for(with_threads(threads), {}, result.size(), [&](std::size_t i) -> Status {
          for (int k = 1; k < 50; ++k) result[i] += std::sin(static_cast<double>(i)) / k;
          return {};
        }));
    return result;
  };
  const auto one = run(1);
  EXPECT_EQ(one, run(2));
  EXPECT_EQ(one, run(5));
}

TEST(ParallelFor, ReturnsTheErrorOfTheIndexThatFails) {
  for (const int threads : {1, 2, 4}) {
    const auto status = parallel_for(with_threads(threads), "x", 300, [](std::size_t i) -> Status {
      if (i == 137) return fail(Code::kOutOfRange, "index 137", ErrorReason::SPEC_INVALID);
      return {};
    });
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, Code::kOutOfRange);
    EXPECT_EQ(status.error().message, "index 137");
    EXPECT_EQ(status.error().reason, ErrorReason::SPEC_INVALID);
  }
}

TEST(ParallelFor, ReturnsTheSmallestIndexSeenToFail) {
  for (const int threads : {1, 3}) {
    std::mutex mutex;
    std::size_t least = 1000;
    const auto status = parallel_for(with_threads(threads), {}, 1000, [&](std::size_t i) -> Status {
      const std::lock_guard lock(mutex);
      least = std::min(least, i);
      return fail(Code::kInternal, std::to_string(i));
    });
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().message, std::to_string(least));
  }
}

TEST(ParallelFor, ReportsIncreasingProgressUpToOne) {
  Context context = with_threads(3);
  std::vector<double> shares;
  context.report = [&](std::string_view stage, double share) {
    EXPECT_EQ(stage, "velocity");
    shares.push_back(share);  // needs no lock, because report() is called by one thread at a time
  };
  ASSERT_TRUE(parallel_for(context, "velocity", 100, [](std::size_t) -> Status { return {}; }));
  ASSERT_EQ(shares.size(), 100U);
  for (std::size_t i = 1; i < shares.size(); ++i) EXPECT_GT(shares[i], shares[i - 1]);
  EXPECT_GT(shares.front(), 0);
  EXPECT_DOUBLE_EQ(shares.back(), 1);
}

TEST(ParallelFor, StopsOnCancel) {
  for (const int threads : {1, 2}) {
    Context context = with_threads(threads);
    std::atomic<int> calls = 0;
    context.cancelled = [&] { return calls >= 10; };
    const auto status = parallel_for(context, "x", 100000, [&](std::size_t) -> Status {
      ++calls;
      return {};
    });
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, Code::kCancelled);
    EXPECT_LE(calls, 10 + threads);
  }
}

TEST(ParallelFor, DoesNothingWhenCancelledBefore) {
  Context context;
  context.cancelled = [] { return true; };
  int calls = 0;
  const auto status = parallel_for(context, "x", 10, [&](std::size_t) -> Status {
    ++calls;
    return {};
  });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Code::kCancelled);
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(check_cancelled(context).error().code, Code::kCancelled);
}

TEST(ParallelFor, StopsSoonAfterAFailure) {
  int calls = 0;
  const auto status = parallel_for(with_threads(1), {}, 100000, [&](std::size_t) -> Status {
    return ++calls == 5 ? Status(fail(Code::kInternal, "five")) : Status();
  });
  EXPECT_FALSE(status);
  EXPECT_EQ(calls, 5);
}

TEST(Context, WithoutCallbacksIsSilentAndNeverCancelled) {
  const Context context;
  context.progress("x", 0.5);
  EXPECT_FALSE(context.is_cancelled());
  EXPECT_TRUE(check_cancelled(context));
}

}  // namespace
}  // namespace hydroprint
