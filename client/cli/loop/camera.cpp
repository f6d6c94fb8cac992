#include "client/cli/loop/camera.h"

#include <fmt/format.h>

#include <iostream>

#include "client/calibration.h"
#include "client/cli/loop/jobs.h"
#include "client/loop/control.h"
#include "client/loop/draws.h"
#include "sim/base/artifact_file.h"

namespace hydroprint::cli {
namespace {

constexpr int kViews = 12;
constexpr double kSeconds = 1;  // duration of the capture of each view

/// Shows only the board to the camera, until destroyed.
class HeldBoard {
 public:
  HeldBoard(std::string control, const std::filesystem::path& folder)
      : control_(std::move(control)),
        mesh_(folder / "calibration-board.obj"),
        pose_(folder / "held-board.json") {}
  ~HeldBoard() { static_cast<void>(loop::talk(control_, "show nothing")); }
  HeldBoard(const HeldBoard&) = delete;
  HeldBoard& operator=(const HeldBoard&) = delete;

  Status make() const { return image::write_artifact(mesh_, loop::board_obj()); }
  Status hold(const Pose& X_CB) const {
    HP_RETURN_IF_ERROR(image::write_artifact(pose_, loop::pose_json(X_CB)));
    HP_RETURN_IF_ERROR(
        loop::talk(control_, fmt::format("show {} {}", loop::quoted(pose_), loop::quoted(mesh_))));
    return {};
  }

 private:
  std::string control_;
  std::filesystem::path mesh_, pose_;
};

/// Returns the calibration that a job produced.
Result<std::string> made_by(Program& program, const std::string& job) {
  HP_ASSIGN_OR_RETURN(const auto list, client::list_calibrations(program.daemon(), 100));
  for (const v1::Calibration& one : list.calibrations()) {
    if (one.job() == job) return one.name();
  }
  return fail(Code::kAborted,
              job + " has no calibration; it may have been deleted. Run the loop again");
}

}  // namespace

Result<std::string> calibrate_loop_camera(Program& program, const std::string& control,
                                          const std::filesystem::path& folder, std::uint32_t seed) {
  const auto say = [&](const std::string& what) {
    if (!program.json()) std::cerr << "camera: " << what << std::endl;
  };
  v1::Job job;
  {
    const HeldBoard board(control, folder);
    HP_RETURN_IF_ERROR(board.make());
    for (int i = 0; i < kViews; ++i) {
      say(fmt::format("view {} of {}", i + 1, kViews));
      HP_RETURN_IF_ERROR(board.hold(loop::held_board(seed, i)));
      HP_ASSIGN_OR_RETURN(const v1::Job capture, capture_quietly(program, kSeconds));
      job.mutable_calibrate_camera()->add_capture_jobs(capture.name());
    }
  }
  say("calibrate-camera");
  HP_ASSIGN_OR_RETURN(const v1::Job ended, run_quietly(program, job));
  return made_by(program, ended.name());
}

}  // namespace hydroprint::cli
