#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hydroprint::worker {

/// A stage of the work and its typical share of the total time.
struct Stage {
  std::string name;
  double weight = 0;
};

/// Progress of the work at one point in time.
struct ProgressReport {
  std::string stage;
  double fraction = 0;          ///< progress of the stage, [0, 1]
  double total_fraction = 0;    ///< progress of the whole work, [0, 1], never decreasing
  std::optional<double> eta_s;  ///< nullopt: too early to estimate
};

/// Converts the progress of single stages to total progress, seconds per stage and time left. This
/// class reads the clock; the simulation does not.
class Progress {
 public:
  /// @param stages  in the order of work; a stage that recurs is listed each time. Skipped stages
  ///                count as done. A stage that is not among the remaining ones adds nothing to the
  ///                total.
  /// @param now_s   a monotonic clock
  /// @param sink    called at the beginning and end of each stage, and at most ten times a second
  ///                in between
  Progress(std::vector<Stage> stages, std::function<double()> now_s,
           std::function<void(const ProgressReport&)> sink);

  /// The callback for Context::report.
  void update(std::string_view stage, double fraction);
  /// Seconds spent in each stage so far, in order of first appearance.
  [[nodiscard]] std::vector<std::pair<std::string, double>> stage_seconds() const;
  [[nodiscard]] double total_s() const { return now_s_() - start_s_; }

 private:
  void enter(std::string_view stage);
  [[nodiscard]] ProgressReport report(double now_s);

  std::vector<Stage> stages_;
  std::function<double()> now_s_;
  std::function<void(const ProgressReport&)> sink_;
  double start_s_;
  mutable std::mutex mutex_;
  std::string stage_;
  std::size_t next_ = 0;  ///< index in stages_ of the first stage that has not begun
  double before_ = 0;     ///< total weight of the stages before the current one
  double weight_ = 0;     ///< weight of the current stage
  double fraction_ = 0;
  double stage_start_s_;
  double last_told_s_;
  double total_fraction_ = 0;
  std::vector<std::pair<std::string, double>> seconds_;
};

}  // namespace hydroprint::worker
