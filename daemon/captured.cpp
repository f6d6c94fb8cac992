#include "daemon/captured.h"

#include <fcntl.h>

#include <algorithm>

#include "daemon/calibration_use.h"
#include "daemon/earlier_job.h"
#include "daemon/files.h"
#include "daemon/names.h"
#include "hydroprint/v1/job.pb.h"
#include "sim/base/sha256.h"

namespace hydroprint::daemon {
namespace {

constexpr int kMostViews = 30;
constexpr int kMostArtifacts = 1000;
constexpr const char* kLens = "camera.json";

tl::unexpected<Error> taken(const std::string& field, const std::string& from) {
  return invalid_field(field, "is taken from " + from + "; leave one of the two out");
}

/// An artifact of a job that is done, as an input file.
Result<v1::InputFile> adopt(std::int64_t job, const Artifact& artifact, const std::string& name,
                            const CapturedSources& from) {
  HP_ASSIGN_OR_RETURN(
      const Asset asset,
      from.assets.adopt(from.layout.artifacts(job) / artifact.name,
                        {artifact.sha256, artifact.size_bytes, artifact.media_type, 0}));
  v1::InputFile out;
  out.set_name(name);
  out.set_asset("assets/" + asset.sha256);
  return out;
}

/// What a capture took, as files of a folder.
Status add_frames(const std::string& capture, const std::string& field, const std::string& folder,
                  const CapturedSources& from,
                  google::protobuf::RepeatedPtrField<v1::InputFile>& out) {
  HP_ASSIGN_OR_RETURN(const Job job, earlier_job(capture, "capture", field, from.jobs));
  HP_ASSIGN_OR_RETURN(const auto artifacts, from.jobs.artifacts(job.id, "", kMostArtifacts));
  for (const Artifact& artifact : artifacts) {
    HP_ASSIGN_OR_RETURN(*out.Add(), adopt(job.id, artifact, folder + "/" + artifact.name, from));
  }
  return {};
}

/// Text as an asset. (The file that it comes from may be written again.)
Result<std::string> store_text(const std::string& text, const CapturedSources& from) {
  const auto path = from.layout.runs() / ("text-" + make_token());
  const auto written = [&]() -> Result<std::string> {
    HP_ASSIGN_OR_RETURN(const UniqueFd file, open_file(path, O_WRONLY | O_CREAT | O_EXCL));
    HP_RETURN_IF_ERROR(write_at(file, path, text, 0));
    HP_ASSIGN_OR_RETURN(
        const Asset asset,
        from.assets.adopt(
            path, {sha256(text), static_cast<std::int64_t>(text.size()), "application/toml", 0}));
    return "assets/" + asset.sha256;
  };
  auto out = written();
  discard(path);
  return out;
}

Status take_layout(v1::CalibrateSpec& spec, const CapturedSources& from) {
  if (spec.has_layout()) return {};
  if (from.camera.layout.empty()) {
    return invalid_field(
        "calibrate.layout",
        "is missing, and the daemon's configuration has no camera.layout; give one");
  }
  HP_ASSIGN_OR_RETURN(const std::string text, read_layout_text(from.camera));
  HP_ASSIGN_OR_RETURN(const std::string asset, store_text(text, from));
  spec.mutable_layout()->set_name("rig/layout.toml");
  spec.mutable_layout()->set_asset(asset);
  return {};
}

Result<std::optional<Calibration>> lens_of(const v1::CalibrateSpec& spec,
                                           CalibrationStore& calibrations) {
  if (spec.camera_calibration().empty()) return calibrations.active(CalibrationKind::kCamera);
  HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_calibration_name(spec.camera_calibration()));
  auto found = calibrations.get(id);
  if (!found && found.error().code == Code::kNotFound) {
    return tl::unexpected(Error{Code::kFailedPrecondition,
                                "calibrate.camera_calibration: " + found.error().message +
                                    "; name another one, or calibrate the camera",
                                "CALIBRATION_MISSING",
                                {{"calibration", spec.camera_calibration()}}});
  }
  HP_RETURN_IF_ERROR(found);
  if (found->made.kind != CalibrationKind::kCamera) {
    return invalid_field("calibrate.camera_calibration",
                         "names the calibration of an object; name one of a camera");
  }
  return std::optional(std::move(*found));
}

Status take_lens(v1::CalibrateSpec& spec, const CapturedSources& from) {
  if (spec.has_camera()) {
    if (spec.camera_calibration().empty()) return {};
    return taken("calibrate.camera", "camera_calibration");
  }
  HP_ASSIGN_OR_RETURN(const auto lens, lens_of(spec, from.calibrations));
  if (!lens) return {};
  spec.set_camera_calibration(calibration_name(lens->id));
  HP_ASSIGN_OR_RETURN(const Artifact artifact, from.jobs.artifact(lens->made.job, kLens));
  HP_ASSIGN_OR_RETURN(*spec.mutable_camera(),
                      adopt(lens->made.job, artifact, std::string("rig/") + kLens, from));
  return {};
}

/// Where the gripper was, if the configuration and the capture tell it.
Status take_gripper(v1::CalibrateSpec& spec, const CapturedSources& from) {
  if (spec.has_gripper_mm() || spec.capture_job().empty() || !from.camera.gripper_water_mm) {
    return {};
  }
  HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(spec.capture_job()));
  HP_ASSIGN_OR_RETURN(const auto captured, from.calibrations.capture(id));
  if (!captured || !captured->place.homed) return {};
  spec.set_gripper_mm(*from.camera.gripper_water_mm - captured->place.axis_mm);
  return {};
}

Status take(v1::CalibrateSpec& spec, const CapturedSources& from) {
  if (!spec.capture_job().empty()) {
    if (spec.frames_size() > 0) return taken("calibrate.frames", "capture_job");
    HP_RETURN_IF_ERROR(add_frames(spec.capture_job(), "calibrate.capture_job", "frames", from,
                                  *spec.mutable_frames()));
  }
  HP_RETURN_IF_ERROR(take_layout(spec, from));
  HP_RETURN_IF_ERROR(take_lens(spec, from));
  return take_gripper(spec, from);
}

Status take(v1::CalibrateCameraSpec& spec, const CapturedSources& from) {
  if (spec.capture_jobs().empty()) return {};
  if (spec.frames_size() > 0) return taken("calibrate_camera.frames", "capture_jobs");
  if (spec.capture_jobs_size() > kMostViews) {
    return invalid_field("calibrate_camera.capture_jobs", "are more than 30");
  }
  int view = 0;
  for (const std::string& capture : spec.capture_jobs()) {
    HP_RETURN_IF_ERROR(add_frames(capture, "calibrate_camera.capture_jobs",
                                  "view" + std::to_string(++view), from, *spec.mutable_frames()));
  }
  return {};
}

}  // namespace

Result<v1::Job> with_captured(const v1::Job& job, const CapturedSources& from) {
  v1::Job out = job;
  if (job.has_calibrate()) HP_RETURN_IF_ERROR(take(*out.mutable_calibrate(), from));
  if (job.has_calibrate_camera()) HP_RETURN_IF_ERROR(take(*out.mutable_calibrate_camera(), from));
  return out;
}

}  // namespace hydroprint::daemon
