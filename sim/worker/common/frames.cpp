#include "sim/worker/common/frames.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "sim/calibrate/calibrate.h"
#include "sim/calibrate/camera_file.h"
#include "sim/worker/common/fields.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kListing = "frames.json";

}  // namespace

Result<std::vector<std::filesystem::path>> frames_folders(
    const std::vector<std::filesystem::path>& files, std::size_t most) {
  const std::string suffix = std::string("/") + kListing;
  std::vector<std::filesystem::path> folders;
  for (const std::filesystem::path& file : files) {
    const std::string& name = file.native();
    if (name.ends_with(suffix)) folders.emplace_back(name.substr(0, name.size() - suffix.size()));
  }
  if (folders.empty()) {
    return fail_field(
        Code::kInvalidArgument, "frames",
        "none of the files is FOLDER/frames.json. Name the files that hydroprint-capture wrote");
  }
  if (most > 0 && folders.size() > most) {
    return fail_field(Code::kInvalidArgument, "frames",
                      fmt::format("{} folders are given. Use at most {}", folders.size(), most));
  }
  return folders;
}

void append_frames(std::vector<InputPath>& files,
                   const std::vector<std::filesystem::path>& folders) {
  for (const auto& folder : folders) files.push_back({"frames", folder / kListing});
}

void add_frames_flag(Flags& flags) { flags.require_folders("frames", kListing); }

Result<Scan> read_scan(const std::filesystem::path& folder, const std::filesystem::path& camera,
                       const Context& context) {
  Scan out;
  HP_ASSIGN_OR_RETURN(out.frames, calibrate::read_frames(folder, context));
  if (camera.empty()) {
    out.camera = calibrate::uncalibrated(out.frames.nominal_lens);
  } else {
    HP_ASSIGN_OR_RETURN(out.camera, calibrate::read_camera(camera));
  }
  return out;
}

void set_film_frame(const registration::FilmFrame& frame, v1::FilmFrameFacts& out) {
  set_pose(frame.X_CF().inverse(), *out.mutable_camera());
  out.set_rms_mm(frame.fit.rms_mm);
  for (const registration::MarkerReport& marker : frame.markers) {
    v1::FilmFrameFacts::Marker& added = *out.add_markers();
    added.set_name(marker.name);
    added.set_used(marker.used);
    added.set_why_not(marker.why_not);
    if (!marker.used) continue;
    added.set_rms_mm(marker.rms_mm);
    added.set_residual_mm(marker.residual_mm);
  }
}

}  // namespace hydroprint::worker
