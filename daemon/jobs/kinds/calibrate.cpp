// Computes the pose of the object over the film from depth frames.
#include "daemon/jobs/adopted_files.h"
#include "daemon/jobs/calibration_report.h"
#include "daemon/jobs/kind.h"
#include "daemon/jobs/spec_fields.h"
#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/job.pb.h"
#include "hydroprint/v1/report.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr const char* kLens = "camera.json";

/// Returns the lens calibration named in a spec, otherwise the active one; nullopt if there is
/// none.
Result<std::optional<Calibration>> lens_of(const v1::CalibrateSpec& spec,
                                           CalibrationStore& calibrations) {
  if (spec.camera_calibration().empty()) return calibrations.active(CalibrationKind::kCamera);
  HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_calibration_name(spec.camera_calibration()));
  auto found = calibrations.get(id);
  if (!found && found.error().code == Code::kNotFound) {
    return tl::unexpected(Error{Code::kFailedPrecondition,
                                "calibrate.camera_calibration: " + found.error().message +
                                    "; name another calibration, or calibrate the camera",
                                ErrorReason::CALIBRATION_MISSING,
                                {{"calibration", spec.camera_calibration()}}});
  }
  HP_RETURN_IF_ERROR(found);
  if (found->definition.kind != CalibrationKind::kCamera) {
    return invalid_field("calibrate.camera_calibration",
                         "names the calibration of an object; name the calibration of a camera");
  }
  return std::optional(std::move(*found));
}

class CalibrateKind final : public KindOf<v1::CalibrateSpec> {
 public:
  [[nodiscard]] auth::Role least_role() const override { return auth::Role::kOperator; }
  [[nodiscard]] bool is_cacheable() const override { return false; }

  [[nodiscard]] Result<std::optional<NewCalibration>> calibration(
      const Job& job, const v1::JobReport& report) const override {
    v1::Job body;
    body.ParseFromString(job.definition.body);
    const v1::CalibrateSpec& spec = body.calibrate();
    v1::Calibration found;
    HP_RETURN_IF_ERROR(take_calibration(report.calibrate().calibration(), found));
    take_object(spec, found);
    found.set_display_name(job.definition.display_name);
    NewCalibration out;
    out.owner = job.definition.owner;
    out.job = job.id;
    if (!spec.capture_job().empty()) {
      HP_ASSIGN_OR_RETURN(out.capture, parse_job_name(spec.capture_job()));
    }
    out.body = found.SerializeAsString();
    return std::optional(std::move(out));
  }

 private:
  /// If a capture job is named, the frames are taken from it. Missing fields are taken from other
  /// sources: layout from the configuration, lens from the active camera calibration, gripper
  /// height from the configuration and the axis position during the capture.
  [[nodiscard]] Status resolve_spec(v1::CalibrateSpec& shown, v1::CalibrateSpec& resolved,
                                    const JobSources& sources) const override {
    if (!shown.capture_job().empty()) {
      HP_RETURN_IF_ERROR(adopt_frames(shown.capture_job(), "calibrate.capture_job", "frames",
                                      sources, *resolved.mutable_frames()));
    }
    HP_RETURN_IF_ERROR(take_layout(resolved, sources));
    HP_RETURN_IF_ERROR(take_lens(shown, resolved, sources));
    HP_RETURN_IF_ERROR(take_gripper(shown, sources));
    if (shown.has_gripper_mm()) resolved.set_gripper_mm(shown.gripper_mm());
    resolved.clear_capture_job();
    resolved.clear_camera_calibration();
    return {};
  }

  [[nodiscard]] Status check_spec(const v1::CalibrateSpec& spec) const override {
    HP_RETURN_IF_ERROR(check_polygon(field().name(), spec));
    HP_RETURN_IF_ERROR(check_frames(field().name(), spec.frames(), 1));
    if (spec.has_layout()) return {};
    return invalid_field("calibrate.layout", "is missing");
  }

  [[nodiscard]] static Status take_layout(v1::CalibrateSpec& spec, const JobSources& sources) {
    if (spec.has_layout()) return {};
    if (sources.camera.layout.empty()) {
      return invalid_field(
          "calibrate.layout",
          "is missing; set it, or set camera.layout in the daemon's configuration");
    }
    HP_ASSIGN_OR_RETURN(const std::string text, read_layout_text(sources.camera));
    HP_ASSIGN_OR_RETURN(*spec.mutable_layout(), adopt_text(text, "rig/layout.toml", sources));
    return {};
  }

  [[nodiscard]] static Status take_lens(v1::CalibrateSpec& shown, v1::CalibrateSpec& resolved,
                                        const JobSources& sources) {
    if (shown.has_camera()) return {};
    HP_ASSIGN_OR_RETURN(const auto lens, lens_of(shown, sources.calibrations));
    if (!lens) return {};
    shown.set_camera_calibration(calibration_name(lens->id));
    HP_ASSIGN_OR_RETURN(const Artifact artifact,
                        sources.jobs.artifact(lens->definition.job, kLens));
    HP_ASSIGN_OR_RETURN(
        *resolved.mutable_camera(),
        adopt_artifact(lens->definition.job, artifact, std::string("rig/") + kLens, sources));
    return {};
  }

  /// Sets the gripper height, if the configuration and the capture determine it.
  [[nodiscard]] static Status take_gripper(v1::CalibrateSpec& spec, const JobSources& sources) {
    const auto& gripper_water_mm = sources.camera.gripper_water_mm;
    if (spec.has_gripper_mm() || spec.capture_job().empty() || !gripper_water_mm) return {};
    HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(spec.capture_job()));
    HP_ASSIGN_OR_RETURN(const auto captured, sources.calibrations.capture(id));
    if (!captured || !captured->place.homed) return {};
    spec.set_gripper_mm(*gripper_water_mm - captured->place.axis_mm);
    return {};
  }

  static void take_object(const v1::CalibrateSpec& spec, v1::Calibration& out) {
    *out.mutable_mesh() = spec.mesh();
    out.set_scale(spec.has_scale() ? spec.scale() : 1);
    out.set_film(spec.film());
    for (const v1::InputFile& file : spec.extra_files()) {
      if (spec.film() == "polygon:" + file.name()) *out.mutable_film_file() = file;
    }
  }
};

}  // namespace

const JobKind& calibrate_kind() {
  static const CalibrateKind kind;
  return kind;
}

}  // namespace hydroprint::daemon
