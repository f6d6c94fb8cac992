#pragma once

#include <string>
#include <vector>

#include "daemon/store/calibration_store.h"
#include "hydroprint/v1/calibration_service.pb.h"

namespace hydroprint::daemon {

/// A calibration as the API has it, and whether it still holds with the rig as it is now.
[[nodiscard]] v1::Calibration to_message(const Calibration& calibration, const RigPlace& now);

/// Why what was seen then does not hold any more.
[[nodiscard]] std::vector<v1::Calibration::Staleness> staleness(const RigPlace& then,
                                                                const RigPlace& now);

/// "calibrations/3", "calibrations/active" (the active one of an object). ID_INVALID,
/// CALIBRATION_NOT_FOUND.
[[nodiscard]] Result<Calibration> find_calibration(const std::string& name,
                                                   CalibrationStore& calibrations);

/// As find_calibration(), for a job that goes by the calibration of an object.
/// @param field  of the spec that names it, for errors
/// @return ID_INVALID; CALIBRATION_MISSING; SPEC_INVALID for the calibration of a camera
[[nodiscard]] Result<Calibration> needed_calibration(const std::string& name,
                                                     const std::string& field,
                                                     CalibrationStore& calibrations);

/// Why a calibration may not be used for a mesh now; empty if it may.
struct Objection {
  std::string words;  ///< for people
  std::string names;  ///< for programs: "MOVED,OTHER_OBJECT"
  void add(const std::string& why, const std::string& name);
};
[[nodiscard]] Objection objection(const v1::Calibration& calibration, const v1::InputFile& mesh);

/// Refuses (CALIBRATION_STALE) a calibration with an objection, unless that is allowed.
[[nodiscard]] Status check_objection(const v1::Calibration& calibration, const Objection& objection,
                                     bool is_allowed);

/// Whether the axis still counts from where it did, with the same object on it.
[[nodiscard]] bool knows_contact(const v1::Calibration& calibration);

}  // namespace hydroprint::daemon
