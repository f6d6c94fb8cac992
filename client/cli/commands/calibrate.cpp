#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/job_io/calibration.h"
#include "client/cli/job_io/finish.h"
#include "client/cli/job_io/inputs.h"
#include "client/cli/job_io/submit_flags.h"
#include "client/cli/program/program.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

struct CalibrateOptions {
  SubmitOptions inputs;
  std::string capture_job, frames, camera;
  std::optional<double> seconds;
  client::JobOptions job;
  FinishOptions finish;
};

struct CameraOptions {
  std::vector<std::string> capture_jobs, frames;
  client::JobOptions job;
  FinishOptions finish;
};

/// Uses the given frames, or captures new ones.
Status take_frames(Program& program, const CalibrateOptions& options, Inputs& inputs,
                   v1::CalibrateSpec& spec) {
  if (!options.frames.empty()) {
    HP_ASSIGN_OR_RETURN(const auto frames, inputs.add_frames({options.frames}));
    spec.mutable_frames()->Add(frames.begin(), frames.end());
    return {};
  }
  std::string capture = job_name(options.capture_job);
  if (capture.empty()) {
    HP_ASSIGN_OR_RETURN(capture, capture_frames(program, options.seconds, options.finish.wait));
  }
  spec.set_capture_job(capture);
  return {};
}

/// Accepts the name of a camera calibration, or a file.
Status take_camera(const std::string& camera, Inputs& inputs, v1::CalibrateSpec& spec) {
  const std::string name = calibration_name(camera);
  if (!name.starts_with("calibrations/")) return inputs.add_to(spec, "camera", camera);
  spec.set_camera_calibration(name);
  return {};
}

Result<v1::Job> make_job(Program& program, const CalibrateOptions& options) {
  Inputs inputs(program.daemon());
  HP_ASSIGN_OR_RETURN(v1::Job job, upload_inputs(inputs, options.inputs));
  v1::CalibrateSpec& spec = *job.mutable_calibrate();
  HP_RETURN_IF_ERROR(take_camera(options.camera, inputs, spec));
  HP_RETURN_IF_ERROR(take_frames(program, options, inputs, spec));
  return job;
}

Status calibrate(Program& program, const CalibrateOptions& options) {
  HP_ASSIGN_OR_RETURN(const v1::Job job, make_job(program, options));
  return run_calibration(program, job, options.job, options.finish);
}

Status calibrate_camera(Program& program, const CameraOptions& options) {
  v1::Job job;
  v1::CalibrateCameraSpec& spec = *job.mutable_calibrate_camera();
  Inputs inputs(program.daemon());
  for (const std::string& capture : options.capture_jobs) spec.add_capture_jobs(job_name(capture));
  HP_ASSIGN_OR_RETURN(const auto frames,
                      inputs.add_frames({options.frames.begin(), options.frames.end()}));
  spec.mutable_frames()->Add(frames.begin(), frames.end());
  return run_calibration(program, job, options.job, options.finish);
}

void add_name(CLI::App& command, client::JobOptions& job) {
  command.add_option("--name", job.display_name, "Display name")->type_name("TEXT");
}

constexpr char kCalibrateFooter[] =
    "Captures frames, unless --capture-job or --frames is given, and computes the object's pose\n"
    "over the film from them. The result is stored as a calibration and becomes active.\n"
    "'hydroprint submit simulate --calibration active' and 'hydroprint dip' use it. It stays\n"
    "valid until the axis moves.\n\n"
    "Examples:\n"
    "  hydroprint calibrate --mesh mug.obj --scale 10 --out held\n"
    "  hydroprint calibrate --mesh mug.obj --scale 10 --capture-job 5 --camera 2";

constexpr char kCameraFooter[] =
    "Each view needs 1 s of frames of the calibration board. Hold the board still, fully in view\n"
    "and 30 mm in front of the background. Take twelve views: with the board tilted by 30 degrees\n"
    "in each direction, near and far, and in the corners of the picture.\n\n"
    "Examples:\n"
    "  hydroprint capture --seconds 1     # once for each view\n"
    "  hydroprint calibrate-camera --capture-jobs 1 2 3 4 5 6 7 8 9 10 11 12";

}  // namespace

void add_calibrate(CLI::App& app, Program& program) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command =
      app.add_subcommand("calibrate", "Measure the object's pose over the film with the camera");
  options->inputs.job.mutable_calibrate();
  add_spec_flags(*command, options->inputs,
                 {"mesh", "scale", "pose", "film", "layout", "gripper_mm"});
  auto* seconds =
      command->add_option("--seconds", options->seconds, "Duration of the capture; default 2");
  seconds->type_name("S");
  auto* job = command->add_option("--capture-job", options->capture_job,
                                  "Use the frames of this capture: jobs/7, or 7");
  job->type_name("JOB")->excludes(seconds);
  command
      ->add_option("--frames", options->frames,
                   "Use frames from a folder written by hydroprint-capture")
      ->type_name("DIR")
      ->excludes(seconds, job);
  command
      ->add_option("--camera", options->camera,
                   "Camera calibration: calibrations/2, 2, or a camera.json; default: the active "
                   "one")
      ->type_name("CALIBRATION");
  add_name(*command, options->job);
  add_finish_flags(*command, options->finish);
  command->footer(kCalibrateFooter);
  program.on(*command, [&program, options] { return calibrate(program, *options); });
}

void add_calibrate_camera(CLI::App& app, Program& program) {
  auto options = std::make_shared<CameraOptions>();
  CLI::App* command = app.add_subcommand(
      "calibrate-camera",
      "Calibrate the camera's lens and depth scale from views of the calibration board");
  auto* jobs = command->add_option("--capture-jobs", options->capture_jobs,
                                   "The capture jobs, one for each view: jobs/7, or 7");
  jobs->type_name("JOB");
  command
      ->add_option("--frames", options->frames,
                   "Use views from folders written by hydroprint-capture")
      ->type_name("DIR")
      ->excludes(jobs);
  add_name(*command, options->job);
  add_finish_flags(*command, options->finish);
  command->footer(kCameraFooter);
  program.on(*command, [&program, options] { return calibrate_camera(program, *options); });
}

}  // namespace hydroprint::cli
