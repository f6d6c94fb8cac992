#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/dip/plan.h"
#include "hardware/rig/samples.h"

namespace hydroprint::dip {

/// One step as it was. Times are seconds since the dip was created.
struct StepRecord {
  Step step = Step::kPrintFilm;
  double begin_s = 0;
  std::optional<double> end_s;      ///< none: it was the last one
  std::optional<double> planned_s;  ///< of clocks and motions
  std::string confirmed_by;         ///< who had the lease; empty: nobody confirmed it
};

/// What report.json of a dip says.
struct Facts {
  std::string job;  ///< "jobs/7"
  std::string create_time;
  std::string drive;
  bool is_virtual = false;
  std::string lease_holder;  ///< who created it
  Plan plan;
  Stand stand;
  std::optional<Ways> ways;
  std::vector<StepRecord> steps;
  Warnings warnings;
  std::optional<double> deepest_mm;           ///< of all positions since first contact, below it
  std::optional<rig::ConstantSpeed> descent;  ///< below first contact
  std::string outcome;                        ///< "SUCCEEDED"; "RUNNING" while it is open
  std::string reason;                         ///< of a failure
  std::string message;
};

/// JSON of a report, one object.
[[nodiscard]] std::string report_json(const Facts& facts);

/// The report of a dip whose daemon was lost, with its outcome set; as it was if it is no report.
[[nodiscard]] std::string interrupted_report(const std::string& json, const std::string& message);

/// How constant the speed of the descent was where the object is in the water.
[[nodiscard]] rig::ConstantSpeed immersion_speed(std::span<const rig::Sample> samples,
                                                 std::uint64_t motion, double contact_mm);

/// The position log, positions.csv: written as samples come, so that it is there after a crash.
class PositionLog {
 public:
  static constexpr const char* kName = "positions.csv";

  /// @param begun  where its time starts: when the dip was created
  PositionLog(const std::filesystem::path& folder, rig::TimePoint begun);

  /// Appends samples of a motion ("clear", "dip").
  void add(std::span<const rig::Sample> samples, std::string_view motion, double contact_mm);
  /// Hands over to the system what was added. kResourceExhausted, DISK_FULL if it could not be
  /// written.
  [[nodiscard]] Status flush();

 private:
  std::filesystem::path path_;
  rig::TimePoint begun_;
  std::ofstream file_;
};

inline constexpr const char* kReportName = "report.json";

/// Writes report.json whole, or leaves the one before. kResourceExhausted, DISK_FULL.
[[nodiscard]] Status write_report(const std::filesystem::path& folder, const std::string& json);

}  // namespace hydroprint::dip
