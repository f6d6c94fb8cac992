#include "sim/worker/flags.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kCalibrateExamples =
    R"(calibration.json: the object's pose in the film frame with its covariance, what the scan does not tell and the
nominal pose does, what became of each marker, and the water's level. pose.json: the pose for simulate --pose.
alignment.png: the scan's points over the mesh by how far they are off; error.png: how well the surface's place is known.

Examples:
  hydroprint-capture --seconds 2 --out frames
  hydroprint-worker calibrate --frames frames --layout rig_layout.toml --camera camera.json --mesh mug.obj --scale 10 --out held
  hydroprint-worker simulate --mesh mug.obj --scale 10 --pose held/pose.json --out film

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr const char* kCalibrateCameraExamples =
    R"(Each view: 1 s of frames of the calibration board (sim/registration), held still, whole in view and 30 mm before what
is behind it; twelve views, tilted each way by 30 degrees, near and far, and out to the corners of the image.

Example:
  hydroprint-worker calibrate-camera --frames view1 view2 view3 view4 view5 view6 --out camera

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr const char* kFuseExamples =
    R"(scan.ply: the surface that a camera saw while it was swept by hand, by volume of signed distances, in mm; with
--layout in the film frame and cut off outside the bars, else in the camera's frame at its first depth frame.
camera_path.csv: where the camera was. Begin with the markers in view, keep 0.6 to 1.2 m away, and take 10 s.

Examples:
  hydroprint-capture --seconds 10 --record sweep.oni --out sweep
  hydroprint-worker fuse --frames sweep --layout rig_layout.toml --camera camera.json --out fused

Exit status: 0 done, 2 bad usage, 3 bad input (the camera was lost among it), 4 the computation failed, 130 cancelled.)";

/// Folders that hydroprint-capture wrote.
CLI::Option* add_frames(CLI::App& app, Options& o, const std::string& description) {
  return app
      .add_option_function<std::vector<std::string>>(
          "--frames",
          [&o](const std::vector<std::string>& folders) {
            o.frames.assign(folders.begin(), folders.end());
          },
          description)
      ->required()
      ->type_name("DIR");
}

void add_calibrate(CLI::App& app, Options& o) {
  add_run(app, o);
  add_frames(app, o, "Depth frames: a folder of hydroprint-capture")->expected(1);
  add_path(app, "--layout", o.layout, "The rig's markers and camera", "FILE.toml")->required();
  add_path(app, "--camera", o.camera,
           "The camera's lens, of calibrate-camera; default: what its driver says", "FILE.json");
  add_object(app, o);
  add_film(app, o);
  app.add_option("--gripper-mm", o.gripper_mm,
                 "Height of the gripper's lower end over the water, which holds the object's top; "
                 "default: there is none in view");
}

void add_calibrate_camera(CLI::App& app, Options& o) {
  add_run(app, o);
  add_frames(app, o, "Views of the board: folders of hydroprint-capture")->expected(1, -1);
}

void add_fuse(CLI::App& app, Options& o) {
  add_run(app, o);
  add_frames(app, o, "Depth frames of a camera swept by hand: a folder of hydroprint-capture")
      ->expected(1);
  add_path(app, "--layout", o.layout, "The rig's markers and camera", "FILE.toml");
  add_path(app, "--camera", o.camera,
           "The camera's lens, of calibrate-camera; default: what its driver says", "FILE.json");
  app.add_option("--voxel-mm", o.voxel_mm, "How fine the volume is")->capture_default_str();
}

}  // namespace

void add_sight_verbs(CLI::App& program, Typed& typed) {
  Options& o = typed.options;
  add_calibrate(
      add_verb(program, typed, Verb::kCalibrate, "calibrate",
               "From depth frames to the object's pose over the film, and how well it is known",
               kCalibrateExamples),
      o);
  add_calibrate_camera(
      add_verb(program, typed, Verb::kCalibrateCamera, "calibrate-camera",
               "From views of the calibration board to a camera's lens and depth scale",
               kCalibrateCameraExamples),
      o);
  add_fuse(add_verb(program, typed, Verb::kFuse, "fuse",
                    "From depth frames of a camera swept by hand to the surface that they show",
                    kFuseExamples),
           o);
}

}  // namespace hydroprint::worker
