#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/store/rig_place.h"

namespace hydroprint::daemon {

/// Kinds of calibration; numbers as in hydroprint.v1.Calibration.Kind.
enum class CalibrationKind : std::int8_t { kObject = 1, kCamera = 2 };

/// The data of a new calibration.
struct NewCalibration {
  CalibrationKind kind = CalibrationKind::kObject;
  std::string owner;
  std::int64_t job = 0;      ///< job that produced it; 0: entered by hand
  std::int64_t capture = 0;  ///< job that took its frames; 0: unknown
  std::string body;          ///< the result: a serialised hydroprint.v1.Calibration
};

/// Time of a capture, and the state of the rig at that time.
struct Captured {
  std::int64_t time_ms = 0;
  RigPlace place;
};

/// A stored calibration.
struct Calibration {
  std::int64_t id = 0;
  NewCalibration definition;
  bool active = false;
  std::int64_t create_ms = 0;
  std::optional<Captured> captured;
};

}  // namespace hydroprint::daemon
