#pragma once

#include <string>
#include <vector>

#include "daemon/store/calibration_store.h"
#include "hydroprint/v1/calibration_service.pb.h"

namespace hydroprint::daemon {

/// Converts a calibration to its API message, with its validity for the current state of the rig.
[[nodiscard]] v1::Calibration to_message(const Calibration& calibration, const RigPlace& now);

/// Returns the pose of a calibration together with its stated error.
[[nodiscard]] v1::Pose stated_pose(const v1::Calibration& calibration);

/// Returns the reasons why an observation made in the rig's state `then` is not valid in its state
/// `now`.
[[nodiscard]] std::vector<v1::Calibration::Staleness> staleness(const RigPlace& then,
                                                                const RigPlace& now);

/// Looks up "calibrations/3", or "calibrations/active" for the active object calibration. Errors:
/// ID_INVALID, CALIBRATION_NOT_FOUND.
[[nodiscard]] Result<Calibration> find_calibration(const std::string& name,
                                                   CalibrationStore& calibrations);

/// Same as find_calibration(), for a job that needs an object calibration.
/// @param field  name of the spec's field that names the calibration, for errors
/// @return ID_INVALID; CALIBRATION_MISSING; SPEC_INVALID for a camera calibration
[[nodiscard]] Result<Calibration> needed_calibration(const std::string& name,
                                                     const std::string& field,
                                                     CalibrationStore& calibrations);

/// Why a calibration cannot be used for a mesh now; empty if it can.
struct Objection {
  std::string words;  ///< text for display
  std::string names;  ///< codes for programs: "MOVED,OTHER_OBJECT"
  void add(const std::string& why, const std::string& name);
};
[[nodiscard]] Objection objection(const v1::Calibration& calibration, const v1::InputFile& mesh);

/// Returns CALIBRATION_STALE if there is an objection, unless stale calibrations are allowed.
[[nodiscard]] Status check_objection(const v1::Calibration& calibration, const Objection& objection,
                                     bool is_allowed);

/// Returns whether the calibration still determines the axis position of first contact: since then,
/// the axis has kept its reference, and nothing was dipped.
[[nodiscard]] bool knows_contact(const v1::Calibration& calibration);

}  // namespace hydroprint::daemon
