// Calibrates the camera's lens from views of the calibration board.
#include <fmt/format.h>

#include "daemon/jobs/adopted_files.h"
#include "daemon/jobs/calibration_report.h"
#include "daemon/jobs/kind.h"
#include "daemon/jobs/spec_fields.h"
#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/report.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr int kMostViews = 30;

class CalibrateCameraKind final : public KindOf<v1::CalibrateCameraSpec> {
 public:
  [[nodiscard]] auth::Role least_role() const override { return auth::Role::kOperator; }
  [[nodiscard]] bool is_cacheable() const override { return false; }

  [[nodiscard]] std::string subject(const google::protobuf::Message& shown) const override {
    const auto& spec = static_cast<const v1::CalibrateCameraSpec&>(shown);
    const int views =
        spec.capture_jobs().empty() ? count_views(spec.frames()) : spec.capture_jobs_size();
    return fmt::format("of {} {}", views, views == 1 ? "view" : "views");
  }

  [[nodiscard]] Result<std::optional<NewCalibration>> calibration(
      const Job& job, const v1::JobReport& report) const override {
    v1::Calibration found;
    HP_RETURN_IF_ERROR(take_camera(report.calibrate_camera(), found));
    found.set_display_name(job.definition.display_name);
    NewCalibration out;
    out.kind = CalibrationKind::kCamera;
    out.owner = job.definition.owner;
    out.job = job.id;
    out.body = found.SerializeAsString();
    return std::optional(std::move(out));
  }

 private:
  /// If capture jobs are named, the frames are taken from them.
  [[nodiscard]] Status resolve_spec(v1::CalibrateCameraSpec& shown,
                                    v1::CalibrateCameraSpec& resolved,
                                    const JobSources& sources) const override {
    if (shown.capture_jobs().empty()) return {};
    if (shown.capture_jobs_size() > kMostViews) {
      return invalid_field("calibrate_camera.capture_jobs",
                           "has more than 30 entries; leave some out");
    }
    int view = 0;
    for (const std::string& capture : shown.capture_jobs()) {
      HP_RETURN_IF_ERROR(adopt_frames(capture, "calibrate_camera.capture_jobs",
                                      fmt::format("view{}", ++view), sources,
                                      *resolved.mutable_frames()));
    }
    resolved.clear_capture_jobs();
    return {};
  }

  [[nodiscard]] Status check_spec(const v1::CalibrateCameraSpec& spec) const override {
    return check_frames(field().name(), spec.frames(), kMostViews);
  }
};

}  // namespace

const JobKind& calibrate_camera_kind() {
  static const CalibrateCameraKind kind;
  return kind;
}

}  // namespace hydroprint::daemon
