#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/time.h"

namespace hydroprint::client {

/// The guided immersion on the rig; the fields are those of the API's DipSpec. The daemon fills
/// fields that are not set, from the simulation if there is one.
struct DipSpec {
  std::string simulate_job;        ///< "jobs/7"; if empty, `depth_mm` is required
  std::optional<double> depth_mm;  ///< below first contact
  std::optional<double> speed_mm_per_s;
  std::optional<double> hold_s;
  std::optional<double> retract_speed_mm_per_s;
  std::optional<double> clearance_mm;
  std::optional<double> film_area_mm2;
  std::optional<double> activator_ml_per_m2;
  std::optional<double> soak_s;
  std::optional<double> activator_wait_s;
  std::optional<double> activation_window_s;
  std::optional<double> water_temperature_c;
  std::string calibration;  ///< "calibrations/3"; empty: that of the simulation, if any
  bool allow_stale_calibration = false;
  bool yes_to_all = false;  ///< skips confirmations and timers; hydroprint-virtual-rig only
};

/// The steps of a dip, in order.
enum class DipStep {
  kUnknown,
  kPrintFilm,
  kLoadObject,
  kFindContact,
  kClear,
  kLayFilm,
  kSoak,
  kSprayActivator,
  kActivate,
  kStartDip,
  kDescend,
  kHold,
  kRetract
};

/// "PRINT_FILM", "LOAD_OBJECT", ... as in the API; "UNKNOWN" for values that this client does not
/// know.
[[nodiscard]] std::string_view name_of(DipStep step);

/// Returns the step with that name; kUnknown if there is none.
[[nodiscard]] DipStep dip_step_of(std::string_view name);

/// Whether the operator has to confirm this step.
[[nodiscard]] bool waits_for_operator(DipStep step);

/// Names of the steps that wait for the operator, in order.
[[nodiscard]] std::vector<std::string> operator_steps();

/// The progress of a dip; the fields are those of the API's DipStatus.
struct DipStatus {
  DipStep step = DipStep::kUnknown;
  std::string instruction;                  ///< what to do now, or what is happening
  std::optional<Time> step_end_time;        ///< when the step's timer or motion ends
  std::optional<Time> activation_end_time;  ///< when the activated film is too old
  std::optional<double> contact_mm;         ///< axis position of first contact, once known
  std::vector<std::string> warnings;        ///< reasons why the print may be poor
};

}  // namespace hydroprint::client
