#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/dip/plan.h"
#include "hardware/rig/samples.h"
#include "hydroprint/v1/report.pb.h"

namespace hydroprint::dip {

/// One completed or current step. Times are in seconds since the dip was created.
struct StepRecord {
  Step step = Step::kPrintFilm;
  double begin_s = 0;
  std::optional<double> end_s;      ///< nullopt: the current step
  std::optional<double> planned_s;  ///< planned duration; only for steps with a clock or a motion
  std::string confirmed_by;  ///< holder of the lease who confirmed the step; empty: not confirmed
};

/// Content of a dip's report.json.
struct Facts {
  std::string job;  ///< "jobs/7"
  std::string create_time;
  std::string drive;
  bool is_virtual = false;
  std::string lease_holder;  ///< holder of the lease who created the dip
  Plan plan;
  Stand stand;
  std::optional<Ways> ways;
  std::vector<StepRecord> steps;
  Warnings warnings;
  std::optional<double> deepest_mm;           ///< largest depth reached, below first contact
  std::optional<rig::ConstantSpeed> descent;  ///< speed of the descent below first contact
  std::string outcome;                        ///< "SUCCEEDED"; "RUNNING" while the dip is open
  ErrorReason reason{};                       ///< only after a failure
  std::string message;
};

/// Returns the content of report.json.
[[nodiscard]] v1::DipReport report_of(const Facts& facts);

/// Evaluates how constant the speed of the descent was below first contact.
[[nodiscard]] rig::ConstantSpeed immersion_speed(std::span<const rig::Sample> samples,
                                                 std::uint64_t motion, double contact_mm);

/// Writes the position log, positions.csv. Samples are appended during the dip, so after a crash at
/// most those since the last flush() are missing.
class PositionLog {
 public:
  static constexpr const char* kName = "positions.csv";

  /// @param begun  origin of the time axis: the creation of the dip
  PositionLog(const std::filesystem::path& folder, rig::TimePoint begun);

  /// Appends samples of a motion ("clear", "dip").
  void add(std::span<const rig::Sample> samples, std::string_view motion, double contact_mm);
  /// Writes buffered samples to the file. Errors: kResourceExhausted, DISK_FULL.
  [[nodiscard]] Status flush();

 private:
  std::filesystem::path path_;
  rig::TimePoint begun_;
  std::ofstream file_;
};

/// Writes report.json atomically: after an error, the previous file remains. Errors:
/// kResourceExhausted, DISK_FULL.
[[nodiscard]] Status write_report(const std::filesystem::path& folder, const v1::DipReport& report);

}  // namespace hydroprint::dip
