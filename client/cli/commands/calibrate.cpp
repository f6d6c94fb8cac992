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

/// Frames that are there, or those of a new capture.
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

/// A calibration of a camera by its name, or a file.
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

/// Follows the job, then tells what it found.
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
  command.add_option("--name", job.display_name, "What people call it")->type_name("TEXT");
}

void add_object_flags(CLI::App& command, CalibrateOptions& options) {
  command.add_option("--mesh", options.mesh, "The object: OBJ, STL, PLY, glTF or GLB")
      ->type_name("FILE")
      ->required();
  command.add_option("--scale", options.spec.scale, "Model units to mm")->type_name("FACTOR");
  command
      .add_option(
          "--pose", options.pose,
          "How it should hang: {\"rotation_wxyz\":[w,x,y,z],\"translation_mm\":[x,y,z]}; it "
          "tells what the scan cannot (a ball's turn)")
      ->type_name("FILE");
  command
      .add_option("--film", options.film,
                  "A4, A3, letter, WxH, circle:RADIUS or polygon:FILE.json, in mm; default A4")
      ->type_name("FILM");
}

constexpr char kCalibrateFooter[] =
    "Takes frames, unless it is given some, and finds the object over the film in them. What it "
    "finds is\n"
    "kept as a calibration, which is active from then on: 'hydroprint submit simulate "
    "--calibration active'\n"
    "and 'hydroprint dip' go by it. It holds as long as the axis stays where it is.\n\n"
    "Examples:\n"
    "  hydroprint calibrate --mesh mug.obj --scale 10 --out held\n"
    "  hydroprint calibrate --mesh mug.obj --scale 10 --capture-job 5 --camera 2";

constexpr char kCameraFooter[] =
    "Each view: 1 s of frames of the calibration board, held still, whole in view and 30 mm before "
    "what\n"
    "is behind it; twelve views, tilted each way by 30 degrees, near and far, and out to the "
    "corners.\n\n"
    "Examples:\n"
    "  hydroprint capture --seconds 1     # once for each view\n"
    "  hydroprint calibrate-camera --capture-jobs 1 2 3 4 5 6 7 8 9 10 11 12";

}  // namespace

void add_calibrate(CLI::App& app, Program& program) {
  auto options = std::make_shared<CalibrateOptions>();
  options->spec.verb = client::Verb::kCalibrate;
  CLI::App* command =
      app.add_subcommand("calibrate", "Find how the object hangs over the film, with the camera");
  add_object_flags(*command, *options);
  auto* seconds =
      command->add_option("--seconds", options->seconds, "How long frames are taken; default 2");
  seconds->type_name("S");
  auto* job = command->add_option("--capture-job", options->capture_job,
                                  "Frames that were taken before: jobs/7, or 7");
  job->type_name("JOB")->excludes(seconds);
  command
      ->add_option("--frames", options->frames,
                   "Frames that were taken elsewhere: a folder of hydroprint-capture")
      ->type_name("DIR")
      ->excludes(seconds, job);
  command
      ->add_option("--layout", options->layout,
                   "The rig's markers and camera, TOML; default: the daemon's camera.layout")
      ->type_name("FILE");
  command
      ->add_option("--camera", options->camera,
                   "The lens: calibrations/2, 2, or a camera.json; default: the active calibration "
                   "of a camera")
      ->type_name("CALIBRATION");
  command
      ->add_option(
          "--gripper-mm", options->spec.scan.gripper_mm,
          "Height of the gripper's lower end over the water; default: the daemon knows it, "
          "or none is in view")
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
      "calibrate-camera", "Find the camera's lens and depth scale, from views of the board");
  auto* jobs = command->add_option("--capture-jobs", options->capture_jobs, "One for each view");
  jobs->type_name("JOB");
  command
      ->add_option("--frames", options->frames,
                   "Views that were taken elsewhere: folders of hydroprint-capture")
      ->type_name("DIR")
      ->excludes(jobs);
  add_name(*command, options->job);
  add_finish_flags(*command, options->finish);
  command->footer(kCameraFooter);
  program.on(*command, [&program, options] { return calibrate_camera(program, *options); });
}

}  // namespace hydroprint::cli
