#include "hardware/rig/samples.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>
#include <thread>

namespace hydroprint::rig {
namespace {

struct Heavy {
  std::array<std::uint64_t, 9> same{};
};

TEST(Seqlock, AReaderNeverSeesAPartialValue) {
  Seqlock<Heavy> lock;
  std::atomic<bool> end{false};
  std::thread writer([&] {
    Heavy value;
    for (std::uint64_t i = 1; i <= 200000; ++i) {
      value.same.fill(i);
      lock.store(value);
    }
    end = true;
  });
  std::uint64_t last = 0;
  while (!end) {
    const Heavy value = lock.load();
    for (const std::uint64_t word : value.same) ASSERT_EQ(word, value.same[0]);
    ASSERT_GE(value.same[0], last);
    last = value.same[0];
  }
  writer.join();
  EXPECT_EQ(lock.load().same[8], 200000U);
}

Sample at(double t_s, double position_mm, std::uint64_t motion = 1, bool cruising = true) {
  Sample sample;
  sample.time = TimePoint(std::chrono::nanoseconds(std::llround(t_s * 1e9)));
  sample.position_mm = position_mm;
  sample.motion = motion;
  sample.leg = 0;
  sample.cruising = cruising;
  return sample;
}

TEST(SampleRing, KeepsTheLatestSamplesInOrder) {
  SampleRing ring;
  EXPECT_EQ(ring.newest(), 0U);
  EXPECT_TRUE(ring.copy(0, 10).empty());
  const std::uint64_t count = SampleRing::kSize + 100;
  for (std::uint64_t i = 1; i <= count; ++i) EXPECT_EQ(ring.add(at(0, double(i))), i);
  const auto all = ring.copy(0, count + 5);
  ASSERT_EQ(all.size(), SampleRing::kSize);
  EXPECT_EQ(all.front().number, 101U);
  EXPECT_EQ(all.back().number, count);
  for (const Sample& sample : all) EXPECT_EQ(sample.position_mm, double(sample.number));
  EXPECT_EQ(ring.copy(200, 202).size(), 3U);
}

TEST(SampleRing, CopiesDuringWritesAreConsistent) {
  SampleRing ring;
  std::atomic<bool> end{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= 3 * SampleRing::kSize; ++i) ring.add(at(0, double(i)));
    end = true;
  });
  while (!end) {
    const std::uint64_t newest = ring.newest();
    for (const Sample& s : ring.copy(newest > 300 ? newest - 300 : 1, newest)) {
      ASSERT_EQ(s.position_mm, double(s.number));
    }
  }
  writer.join();
}

TEST(ConstantSpeed, OfAStraightLineIsItsSlopeWithZeroDeviation) {
  std::vector<Sample> samples;
  for (int i = 0; i < 100; ++i) samples.push_back(at(0.02 * i, 3 - 5 * 0.02 * i));
  const ConstantSpeed speed = constant_speed(samples, 1, 0);
  EXPECT_EQ(speed.samples, 100);
  EXPECT_NEAR(speed.speed_mm_per_s, -5, 1e-9);
  EXPECT_NEAR(speed.largest_way_mm, 0, 1e-9);
  EXPECT_NEAR(speed.largest_share, 0, 1e-9);
}

TEST(ConstantSpeed, FindsASineOfKnownSize) {
  // x = 5 t + A sin(w t), over many whole periods: the line keeps the slope 5 and the deviation is
  // A. Over a window of half a period the mean speed differs by 2 A / (T / 2).
  const double amplitude_mm = 0.05, period_s = 0.4;
  std::vector<Sample> samples;
  for (int i = 0; i <= 4000; ++i) {
    const double t_s = 0.005 * i;
    samples.push_back(at(t_s, 5 * t_s + amplitude_mm * std::sin(2 * M_PI * t_s / period_s)));
  }
  const ConstantSpeed speed = constant_speed(samples, 1, 0, period_s / 2);
  EXPECT_NEAR(speed.speed_mm_per_s, 5, 1e-3);
  EXPECT_NEAR(speed.largest_way_mm, amplitude_mm, 2e-3);
  EXPECT_NEAR(speed.largest_share, 2 * amplitude_mm / (period_s / 2) / 5, 2e-3);
}

TEST(ConstantSpeed, TimeErrorsAreNotADeviation) {
  // A constant 5 mm/s; the times of the samples are wrong by up to their stated error, which is
  // large for a few of them.
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<Sample> samples;
  for (int i = 0; i < 400; ++i) {
    const double error_s = i % 50 == 7 ? 0.02 : 0.0005;
    samples.push_back(at(0.02 * i + error_s * share(random), 5 * 0.02 * i));
    samples.back().time_error_s = error_s;
  }
  const ConstantSpeed speed = constant_speed(samples, 1, 0);
  EXPECT_NEAR(speed.speed_mm_per_s, 5, 1e-3);
  EXPECT_LT(speed.largest_way_mm, 5e-4);
  EXPECT_LT(speed.largest_share, 1e-3);
  EXPECT_NEAR(speed.way_uncertainty_mm, 5 * 0.02, 1e-4);
}

TEST(ConstantSpeed, ADeviationIsFoundDespiteTimeErrors) {
  // The axis lags by 0.08 mm for one second in eight; all times are accurate within 1 ms.
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<Sample> samples;
  for (int i = 0; i < 400; ++i) {
    const double t_s = 0.02 * i;
    const double back_mm = t_s > 3 && t_s < 4 ? 0.08 : 0;
    samples.push_back(at(t_s + 0.001 * share(random), 5 * t_s - back_mm));
    samples.back().time_error_s = 0.001;
  }
  const ConstantSpeed speed = constant_speed(samples, 1, 0);
  EXPECT_GT(speed.largest_way_mm, 0.06);  // the fit absorbs 0.01 mm, and the time errors 0.005 mm
  EXPECT_LT(speed.largest_way_mm, 0.08);
  EXPECT_GT(speed.largest_share, 0.06);  // 0.08 mm of the 1 mm that the axis moves in 0.2 s
}

TEST(ConstantSpeed, LeavesOutRampsAndOtherMotions) {
  std::vector<Sample> samples;
  for (int i = 0; i < 50; ++i) samples.push_back(at(0.02 * i, 0.1 * i));
  samples.push_back(at(1, 1000, 1, false));
  samples.push_back(at(1, 1000, 2));
  const ConstantSpeed speed = constant_speed(samples, 1, 0);
  EXPECT_EQ(speed.samples, 50);
  EXPECT_NEAR(speed.largest_way_mm, 0, 1e-9);
  EXPECT_EQ(constant_speed(samples, 3, 0).samples, 0);
}

}  // namespace
}  // namespace hydroprint::rig
