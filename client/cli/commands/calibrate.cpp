#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/calibration.h"
#include "client/cli/commands/commands.h"
#include "client/cli/format/calibration_text.h"
#include "client/cli/format/json.h"
#include "client/cli/job_io/finish.h"
#include "client/cli/job_io/inputs.h"
#include "client/cli/job_io/wait.h"
#include "client/cli/program/program.h"
#include "client/jobs.h"
#include "client/pose_file.h"

namespace hydroprint::cli {
namespace {

struct CalibrateOptions {
  client::Spec spec;
  std::string mesh, pose, film, capture_job, frames, layout, camera;
  std::optional<double> seconds;
  client::JobOptions job;
  FinishOptions finish;
};

struct CameraOptions {
  client::Spec spec;
  std::vector<std::string> capture_jobs, frames;
  client::JobOptions job;
  FinishOptions finish;
};

std::vector<std::filesystem::path> folders(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

/// Uses the given frames, or captures new ones.
Status take_frames(Program& program, const CalibrateOptions& options, Inputs& inputs,
                   client::ScanSpec& scan) {
  if (!options.frames.empty()) {
    HP_ASSIGN_OR_RETURN(scan.frames, inputs.add_frames({options.frames}));
    return {};
  }
  std::string capture = job_name(options.capture_job);
  if (capture.empty()) {
    HP_ASSIGN_OR_RETURN(const client::Job job,
                        client::create_capture(program.daemon(), options.seconds, {}));
    capture = job.name;
    if (!program.json()) std::cout << capture << std::endl;
    HP_RETURN_IF_ERROR(wait_for(program, capture, options.finish.wait));
  }
  scan.capture_jobs = {capture};
  return {};
}

/// Accepts the name of a camera calibration, or a file.
Status take_camera(const std::string& camera, Inputs& inputs, client::ScanSpec& scan) {
  if (camera.empty()) return {};
  const std::string name = calibration_name(camera);
  if (name.starts_with("calibrations/")) {
    scan.camera_calibration = name;
    return {};
  }
  HP_ASSIGN_OR_RETURN(scan.camera, inputs.add(camera));
  return {};
}

Result<client::Spec> make_spec(Program& program, const CalibrateOptions& options) {
  client::Spec spec = options.spec;
  Inputs inputs(program.daemon());
  if (!options.pose.empty()) {
    HP_ASSIGN_OR_RETURN(spec.pose, client::read_pose_file(options.pose));
  }
  HP_RETURN_IF_ERROR(inputs.add_model(options.mesh, spec));
  if (!options.film.empty()) {
    HP_ASSIGN_OR_RETURN(spec.film, inputs.add_film(options.film, spec));
  }
  HP_ASSIGN_OR_RETURN(spec.scan.layout, inputs.add(options.layout));
  HP_RETURN_IF_ERROR(take_camera(options.camera, inputs, spec.scan));
  HP_RETURN_IF_ERROR(take_frames(program, options, inputs, spec.scan));
  return spec;
}

/// Follows the job, then prints its result.
Status finish(Program& program, const client::Job& job, const FinishOptions& options) {
  HP_RETURN_IF_ERROR(finish_job(program, job, options));
  if (options.no_wait || program.json()) return {};
  HP_ASSIGN_OR_RETURN(const auto found, client::list_calibrations(program.daemon(), 100));
  for (const client::Calibration& calibration : found) {
    if (calibration.job == job.name) std::cout << text_of(calibration) << std::flush;
  }
  return {};
}

Status calibrate(Program& program, const CalibrateOptions& options) {
  HP_ASSIGN_OR_RETURN(const client::Spec spec, make_spec(program, options));
  HP_ASSIGN_OR_RETURN(const client::Job job,
                      client::create_job(program.daemon(), spec, options.job));
  return finish(program, job, options.finish);
}

Status calibrate_camera(Program& program, const CameraOptions& options) {
  client::Spec spec = options.spec;
  Inputs inputs(program.daemon());
  for (const std::string& job : options.capture_jobs) {
    spec.scan.capture_jobs.push_back(job_name(job));
  }
  HP_ASSIGN_OR_RETURN(spec.scan.frames, inputs.add_frames(folders(options.frames)));
  HP_ASSIGN_OR_RETURN(const client::Job job,
                      client::create_job(program.daemon(), spec, options.job));
  return finish(program, job, options.finish);
}

void add_name(CLI::App& command, client::JobOptions& job) {
  command.add_option("--name", job.display_name, "Display name")->type_name("TEXT");
}

void add_object_flags(CLI::App& command, CalibrateOptions& options) {
  command.add_option("--mesh", options.mesh, "The object: OBJ, STL, PLY, glTF or GLB")
      ->type_name("FILE")
      ->required();
  command.add_option("--scale", options.spec.scale, "Model units to mm")->type_name("FACTOR");
  command
      .add_option(
          "--pose", options.pose,
          "Nominal pose: {\"rotation_wxyz\":[w,x,y,z],\"translation_mm\":[x,y,z]}; used for "
          "motions that the scan cannot determine (a ball's rotation)")
      ->type_name("FILE");
  command
      .add_option("--film", options.film,
                  "A4, A3, letter, WxH, circle:RADIUS or polygon:FILE.json, in mm; default A4")
      ->type_name("FILM");
}

constexpr char kCalibrateFooter[] =
    "Captures frames, unless some are given, and finds the pose of the object over the film in\n"
    "them. The result is stored as a calibration and becomes active. 'hydroprint submit simulate\n"
    "--calibration active' and 'hydroprint dip' use it. It stays valid until the axis moves.\n\n"
    "Examples:\n"
    "  hydroprint calibrate --mesh mug.obj --scale 10 --out held\n"
    "  hydroprint calibrate --mesh mug.obj --scale 10 --capture-job 5 --camera 2";

constexpr char kCameraFooter[] =
    "Each view needs 1 s of frames of the calibration board. Hold the board still, fully in view\n"
    "and 30 mm in front of the background. Take twelve views: tilted each way by 30 degrees, near\n"
    "and far, and out to the corners.\n\n"
    "Examples:\n"
    "  hydroprint capture --seconds 1     # once for each view\n"
    "  hydroprint calibrate-camera --capture-jobs 1 2 3 4 5 6 7 8 9 10 11 12";

}  // namespace

void add_calibrate(CLI::App& app, Program& program) {
  auto options = std::make_shared<CalibrateOptions>();
  options->spec.verb = client::Verb::kCalibrate;
  CLI::App* command =
      app.add_subcommand("calibrate", "Measure the object's pose over the film with the camera");
  add_object_flags(*command, *options);
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
      ->add_option("--layout", options->layout,
                   "The rig's markers and camera, TOML; default: the daemon's camera.layout")
      ->type_name("FILE");
  command
      ->add_option("--camera", options->camera,
                   "Camera calibration: calibrations/2, 2, or a camera.json; default: the active "
                   "one")
      ->type_name("CALIBRATION");
  command
      ->add_option("--gripper-mm", options->spec.scan.gripper_mm,
                   "Height of the gripper's lower end above the water; default: from the daemon's "
                   "configuration, or no gripper in view")
      ->type_name("MM");
  add_name(*command, options->job);
  add_finish_flags(*command, options->finish);
  command->footer(kCalibrateFooter);
  program.on(*command, [&program, options] { return calibrate(program, *options); });
}

void add_calibrate_camera(CLI::App& app, Program& program) {
  auto options = std::make_shared<CameraOptions>();
  options->spec.verb = client::Verb::kCalibrateCamera;
  CLI::App* command = app.add_subcommand(
      "calibrate-camera", "Calibrate the camera's lens and depth scale from views of the board");
  auto* jobs = command->add_option("--capture-jobs", options->capture_jobs,
                                   "The captures, one for each view");
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
