#include "hardware/rig/samples.h"

#include <algorithm>
#include <cmath>

namespace hydroprint::rig {
namespace {

struct Line {
  double at_mm = 0;  ///< position at the mean time
  double mean_s = 0;
  double slope = 0;
};

double seconds(const Sample& sample, const Sample& first) {
  return std::chrono::duration<double>(sample.time - first.time).count();
}

// Lower bound of the uncertainty of a sample's time, on which its weight depends.
constexpr double kBestTimeError_s = 2e-4;

double weight(const Sample& sample) {
  const double error_s = std::max(sample.time_error_s, kBestTimeError_s);
  return 1 / (error_s * error_s);
}

Line fit(std::span<const Sample> samples) {
  double all = 0;
  for (const Sample& s : samples) all += weight(s);
  Line line;
  for (const Sample& s : samples) {
    line.mean_s += weight(s) / all * seconds(s, samples.front());
    line.at_mm += weight(s) / all * s.position_mm;
  }
  double above = 0, below = 0;
  for (const Sample& s : samples) {
    const double t = seconds(s, samples.front()) - line.mean_s;
    above += weight(s) * t * (s.position_mm - line.at_mm);
    below += weight(s) * t * t;
  }
  line.slope = below > 0 ? above / below : 0;
  return line;
}

double largest_share(std::span<const Sample> samples, double slope, double window_s) {
  double largest = 0;
  std::size_t from = 0;
  for (std::size_t to = 1; to < samples.size() && slope != 0; ++to) {
    while (from + 1 < to && seconds(samples[to], samples[from + 1]) >= window_s) ++from;
    const double t = seconds(samples[to], samples[from]);
    if (t < window_s) continue;
    const double v = (samples[to].position_mm - samples[from].position_mm) / t;
    const double unsure = (samples[to].time_error_s + samples[from].time_error_s) / t;
    largest = std::max(largest, std::abs(v / slope - 1) - unsure);
  }
  return largest;
}

}  // namespace

SampleRing::SampleRing() : slots_(std::make_unique<std::array<Seqlock<Sample>, kSize>>()) {}

std::uint64_t SampleRing::add(Sample sample) {
  sample.number = newest_.load(std::memory_order_relaxed) + 1;
  (*slots_)[sample.number % kSize].store(sample);
  newest_.store(sample.number, std::memory_order_release);
  return sample.number;
}

std::vector<Sample> SampleRing::copy(std::uint64_t first, std::uint64_t last) const {
  const std::uint64_t newest = this->newest();
  last = std::min(last, newest);
  first = std::max<std::uint64_t>({first, 1, newest >= kSize ? newest - kSize + 1 : 1});
  std::vector<Sample> out;
  for (std::uint64_t number = first; number <= last; ++number) {
    const Sample sample = (*slots_)[number % kSize].load();
    if (sample.number == number) out.push_back(sample);  // otherwise it has just been overwritten
  }
  return out;
}

ConstantSpeed constant_speed(std::span<const Sample> samples, std::uint64_t motion, int leg,
                             double window_s) {
  std::vector<Sample> used;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(used),
               [&](const Sample& s) { return s.motion == motion && s.leg == leg && s.cruising; });
  ConstantSpeed out;
  out.samples = static_cast<int>(used.size());
  out.window_s = window_s;
  if (used.size() < 3) return out;
  const Line line = fit(used);
  out.speed_mm_per_s = line.slope;
  for (const Sample& s : used) {
    const double on_line_mm = line.at_mm + line.slope * (seconds(s, used.front()) - line.mean_s);
    const double unsure_mm = std::abs(line.slope) * s.time_error_s;
    out.largest_way_mm =
        std::max(out.largest_way_mm, std::abs(s.position_mm - on_line_mm) - unsure_mm);
    out.way_uncertainty_mm = std::max(out.way_uncertainty_mm, unsure_mm);
  }
  out.largest_share = largest_share(used, line.slope, window_s);
  return out;
}

}  // namespace hydroprint::rig
