#include "sim/base/process/progress.h"

#include <algorithm>
#include <limits>
#include <span>

namespace hydroprint::worker {
namespace {

constexpr double kInterval_s = 0.1;
// Conditions for an estimate of the time left. An earlier one would only reflect the first stage.
constexpr double kFirstEstimate_s = 0.3;
constexpr double kFirstEstimateFraction = 0.02;

double& seconds_of(std::vector<std::pair<std::string, double>>& seconds, const std::string& stage) {
  const auto found = std::find_if(seconds.begin(), seconds.end(),
                                  [&](const auto& entry) { return entry.first == stage; });
  if (found != seconds.end()) return found->second;
  return seconds.emplace_back(stage, 0).second;
}

double weight_of(std::span<const Stage> stages) {
  double sum = 0;
  for (const Stage& stage : stages) sum += stage.weight;
  return sum;
}

}  // namespace

Progress::Progress(std::vector<Stage> stages, std::function<double()> now_s,
                   std::function<void(const ProgressReport&)> sink)
    : stages_(std::move(stages)),
      now_s_(std::move(now_s)),
      sink_(std::move(sink)),
      start_s_(now_s_()),
      stage_start_s_(start_s_),
      last_told_s_(-std::numeric_limits<double>::infinity()) {}

void Progress::update(std::string_view stage, double fraction) {
  const std::lock_guard lock(mutex_);
  const double now = now_s_();
  const bool new_stage = stage != stage_;
  if (new_stage) {
    if (!stage_.empty()) seconds_of(seconds_, stage_) += now - stage_start_s_;
    enter(stage);
    stage_start_s_ = now;
  }
  const bool was_done = fraction_ >= 1;
  fraction_ = std::clamp(fraction, fraction_, 1.0);
  const bool changed = new_stage || (fraction_ >= 1 && !was_done);
  if (!changed && now - last_told_s_ < kInterval_s) return;
  last_told_s_ = now;
  if (sink_) sink_(report(now));
}

void Progress::enter(std::string_view stage) {
  stage_ = stage;
  fraction_ = 0;
  weight_ = 0;
  const auto ahead = stages_.begin() + static_cast<std::ptrdiff_t>(next_);
  const auto found =
      std::find_if(ahead, stages_.end(), [&](const Stage& s) { return s.name == stage_; });
  if (found == stages_.end()) return;
  next_ = static_cast<std::size_t>(found - stages_.begin()) + 1;
  before_ = weight_of(std::span(stages_.begin(), found));
  weight_ = found->weight;
}

ProgressReport Progress::report(double now_s) {
  if (const double all = weight_of(stages_); all > 0) {
    total_fraction_ = std::clamp((before_ + fraction_ * weight_) / all, total_fraction_, 1.0);
  }
  ProgressReport out{stage_, fraction_, total_fraction_, std::nullopt};
  const double elapsed_s = now_s - start_s_;
  if (elapsed_s >= kFirstEstimate_s && total_fraction_ >= kFirstEstimateFraction) {
    out.eta_s = elapsed_s * (1 - total_fraction_) / total_fraction_;
  }
  return out;
}

std::vector<std::pair<std::string, double>> Progress::stage_seconds() const {
  const std::lock_guard lock(mutex_);
  auto out = seconds_;
  if (!stage_.empty()) seconds_of(out, stage_) += now_s_() - stage_start_s_;
  return out;
}

}  // namespace hydroprint::worker
