// What is seen: calibrate, calibrate-camera, and calibrations that are entered by hand.
#include "daemon/names.h"
#include "daemon/spec.h"
#include "daemon/spec_parts.h"
#include "daemon/spec_works.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr int kMostFrames = 5000;

// Frames as hydroprint-capture wrote them: for each view a folder with frames.json.
void add_frames(WorkBuilder& builder,
                const google::protobuf::RepeatedPtrField<v1::InputFile>& frames, int most_views) {
  constexpr std::string_view kListing = "/frames.json";
  if (frames.size() > kMostFrames) {
    builder.refuse("frames", "are more than 5000 files");
    return;
  }
  int views = 0;
  for (const v1::InputFile& file : frames) {
    builder.file("frames", "", file);
    if (!file.name().ends_with(kListing)) continue;
    builder.flag("frames", file.name().substr(0, file.name().size() - kListing.size()));
    ++views;
  }
  if (views == 0 || views > most_views) {
    builder.refuse("frames", views == 0 ? "have no FOLDER/frames.json; name captures, or upload "
                                          "what hydroprint-capture wrote"
                                        : "are of more views than " + std::to_string(most_views));
  }
}

}  // namespace

Result<Work> work_of(const v1::CalibrateSpec& spec, NewJob& made) {
  WorkBuilder builder("calibrate");
  add_object(builder, spec);
  add_frames(builder, spec.frames(), 1);
  if (spec.has_layout()) {
    builder.file("layout", "layout", spec.layout());
  } else {
    builder.refuse("layout", "is missing");
  }
  if (spec.has_camera()) builder.file("camera", "camera", spec.camera());
  if (spec.has_gripper_mm()) {
    if (!(spec.gripper_mm() >= -1000 && spec.gripper_mm() <= 5000)) {
      builder.refuse("gripper_mm", "must be from -1000 to 5000");
    }
    builder.flag("gripper-mm", text_of(spec.gripper_mm()));
  }
  if (spec.has_threads()) add_threads(builder, spec.threads(), made);
  made.use_cache = false;  // each leaves its calibration
  return builder.build();
}

Result<Work> work_of(const v1::CalibrateCameraSpec& spec, NewJob& made) {
  WorkBuilder builder("calibrate-camera");
  add_frames(builder, spec.frames(), 30);
  if (spec.has_threads()) add_threads(builder, spec.threads(), made);
  made.use_cache = false;
  return builder.build();
}

Result<v1::Calibration> check_calibration(const v1::Calibration& entered) {
  WorkBuilder builder("calibration");
  builder.require(check_text(builder.path("display_name"), entered.display_name(), 200));
  if (!entered.has_mesh()) builder.refuse("mesh", "is missing");
  if (entered.has_mesh()) builder.file("mesh", "mesh", entered.mesh());
  if (!entered.has_pose()) builder.refuse("pose", "is missing");
  if (entered.has_pose()) add_pose(builder, entered.pose());
  const double scale = entered.scale() == 0 ? 1 : entered.scale();
  builder.number("scale", "scale", scale, 1e9);
  if (entered.film().starts_with("polygon:")) {
    builder.refuse("film", "cannot be a polygon here; give its box as WxH");
  } else if (!entered.film().empty()) {
    add_film(builder, entered.film());
  }
  const int spread = entered.covariance_size();
  if (spread != 0 || entered.centre_mm_size() != 0) {
    builder.check_numbers("covariance", {entered.covariance().begin(), entered.covariance().end()},
                          36);
    builder.check_numbers("centre_mm", {entered.centre_mm().begin(), entered.centre_mm().end()}, 3);
  }
  HP_RETURN_IF_ERROR(builder.build());
  v1::Calibration out;
  out.set_display_name(entered.display_name().empty() ? "by hand: " + entered.mesh().name()
                                                      : entered.display_name());
  *out.mutable_mesh() = entered.mesh();
  *out.mutable_pose() = entered.pose();
  out.set_scale(scale);
  out.set_film(entered.film());
  *out.mutable_covariance() = entered.covariance();
  *out.mutable_centre_mm() = entered.centre_mm();
  return out;
}

}  // namespace hydroprint::daemon
