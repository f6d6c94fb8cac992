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

/// Stores calibrations, and the state of the rig during captures. Thread-safe. Methods with a
/// calibration's id return kNotFound, CALIBRATION_NOT_FOUND for an unknown id.
class CalibrationStore {
 public:
  CalibrationStore(Database& database, Clock clock)
      : database_(database), clock_(std::move(clock)) {}

  /// Stores a manually entered calibration, or returns the one that an earlier request with the
  /// same id created.
  /// @return kInvalidArgument, REQUEST_ID_REUSED
  [[nodiscard]] Result<Calibration> create(const NewCalibration& definition,
                                           const RequestKey& request);
  [[nodiscard]] Result<Calibration> get(std::int64_t id);
  /// Returns the active calibration of a kind, if there is one.
  [[nodiscard]] Result<std::optional<Calibration>> active(CalibrationKind kind);
  /// Lists calibrations, newest first.
  /// @param before_id  lists only calibrations older than this one; 0: all
  [[nodiscard]] Result<std::vector<Calibration>> list(std::int64_t before_id, int limit);
  /// Makes a calibration the active one of its kind.
  [[nodiscard]] Result<Calibration> activate(std::int64_t id);
  [[nodiscard]] Status remove(std::int64_t id);

  /// Returns the state of the rig when a job captured its frames; nullopt if it captured none.
  [[nodiscard]] Result<std::optional<Captured>> capture(std::int64_t job);
  /// Stores the state of the rig at the start of a capture.
  [[nodiscard]] Status note_capture(std::int64_t job, const RigPlace& place);

 private:
  [[nodiscard]] Result<std::vector<Calibration>> select(const std::string& where,
                                                        std::initializer_list<DbValue> values);

  Database& database_;
  Clock clock_;
};

/// Stores a calibration and makes it the active one of its kind. Call this within the transaction
/// that stores its source: the end of the job, or the request for a manual entry.
/// @return the calibration's id
[[nodiscard]] Result<std::int64_t> insert_calibration(Database& database,
                                                      const NewCalibration& definition,
                                                      std::int64_t now_ms);

/// Returns the id of the calibration that a job produced; 0 if there is none.
[[nodiscard]] Result<std::int64_t> calibration_of_job(Database& database, std::int64_t job);

}  // namespace hydroprint::daemon
