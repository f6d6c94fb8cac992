#include "daemon/jobs/entered_calibration.h"

#include "daemon/jobs/spec_files.h"
#include "daemon/platform/resource_names.h"
#include "sim/base/pose_uncertainty.h"

namespace hydroprint::daemon {

Result<v1::Calibration> check_calibration(const v1::Calibration& entered) {
  if (!entered.has_mesh()) return invalid_field("calibration.mesh", "is missing");
  if (!entered.has_pose()) return invalid_field("calibration.pose", "is missing");
  if (entered.film().starts_with("polygon:")) {
    return invalid_field("calibration.film",
                         "cannot be a polygon here; use its bounding box as WxH");
  }
  if (entered.covariance().empty() != entered.centre_mm().empty()) {
    return invalid_field(
        entered.centre_mm().empty() ? "calibration.centre_mm" : "calibration.covariance",
        "is missing; covariance and centre_mm belong together");
  }
  v1::Calibration out;
  out.set_display_name(entered.display_name().empty() ? "by hand: " + entered.mesh().name()
                                                      : entered.display_name());
  *out.mutable_mesh() = entered.mesh();
  *out.mutable_pose() = entered.pose();
  out.mutable_pose()->clear_error_p95_mm();
  out.mutable_pose()->clear_from_nominal_pose();
  set_uncertainty(uncertainty_of(entered.pose()), out);
  out.set_scale(entered.scale() == 0 ? 1 : entered.scale());
  out.set_film(entered.film());
  *out.mutable_covariance() = entered.covariance();
  *out.mutable_centre_mm() = entered.centre_mm();
  HP_RETURN_IF_ERROR(input_files(out, "calibration"));
  return out;
}

}  // namespace hydroprint::daemon
