#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/store/rig_place.h"

namespace hydroprint::daemon {

/// Kinds of calibration; numbers as in hydroprint.v1.Calibration.Kind.
enum class CalibrationKind : std::int8_t { kObject = 1, kCamera = 2 };

/// What makes a calibration.
struct NewCalibration {
  CalibrationKind kind = CalibrationKind::kObject;
  std::string owner;
  std::int64_t job = 0;      ///< that made it; 0: entered by hand
  std::int64_t capture = 0;  ///< the job that took its frames; 0: nobody knows
  std::string body;          ///< a hydroprint.v1.Calibration, serialised: what was found
};

/// Where the rig was when frames were taken, and when that was.
struct Captured {
  std::int64_t time_ms = 0;
  RigPlace place;
};

/// A calibration as it is stored.
struct Calibration {
  std::int64_t id = 0;
  NewCalibration made;
  bool active = false;
  std::int64_t create_ms = 0;
  std::optional<Captured> captured;
};

}  // namespace hydroprint::daemon
