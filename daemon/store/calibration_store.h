#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/platform/clock.h"
#include "daemon/store/calibration.h"
#include "daemon/store/database/database.h"
#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// Calibrations, and where the rig was when frames were taken. Any thread may call. Where one is
/// named that is not there: kNotFound, CALIBRATION_NOT_FOUND.
class CalibrationStore {
 public:
  CalibrationStore(Database& database, Clock clock)
      : database_(database), clock_(std::move(clock)) {}

  /// Stores one that was entered by hand, or returns the one that the same request made before.
  /// @return kInvalidArgument, REQUEST_ID_REUSED
  [[nodiscard]] Result<Calibration> create(const NewCalibration& made, const RequestKey& request);
  [[nodiscard]] Result<Calibration> get(std::int64_t id);
  /// The active one of a kind, if there is one.
  [[nodiscard]] Result<std::optional<Calibration>> active(CalibrationKind kind);
  /// Newest first.
  /// @param before_id  only older ones; 0: all
  [[nodiscard]] Result<std::vector<Calibration>> list(std::int64_t before_id, int limit);
  /// Makes it the active one of its kind.
  [[nodiscard]] Result<Calibration> activate(std::int64_t id);
  [[nodiscard]] Status remove(std::int64_t id);

  /// Where the rig was when that job took its frames; none if it took none.
  [[nodiscard]] Result<std::optional<Captured>> capture(std::int64_t job);
  /// Keeps where the rig was when a capture began.
  [[nodiscard]] Status note_capture(std::int64_t job, const RigPlace& place);

 private:
  [[nodiscard]] Result<std::vector<Calibration>> select(const std::string& where,
                                                        std::initializer_list<DbValue> values);

  Database& database_;
  Clock clock_;
};

/// Stores a calibration, which becomes the active one of its kind, within the transaction that
/// brings it about. @return its id
[[nodiscard]] Result<std::int64_t> insert_calibration(Database& database,
                                                      const NewCalibration& made,
                                                      std::int64_t now_ms);

/// The calibration that a job made; 0 if there is none.
[[nodiscard]] Result<std::int64_t> calibration_of_job(Database& database, std::int64_t job);

}  // namespace hydroprint::daemon
