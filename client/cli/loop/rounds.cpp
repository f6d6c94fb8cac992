#include "client/cli/loop/rounds.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <fstream>
#include <iostream>
#include <sstream>
#include <utility>

#include "client/artifacts.h"
#include "client/cli/job_io/wait.h"
#include "client/cli/loop/camera.h"
#include "client/cli/loop/jobs.h"
#include "client/cli/rig_session/motion.h"
#include "client/jobs.h"
#include "client/loop/control.h"
#include "client/rig.h"
#include "sim/base/artifact_file.h"
#include "sim/base/checked_json.h"
#include "sim/sample/sample.h"

namespace hydroprint::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kAbove_mm = 40;       ///< the object's lowest point above the water in captures
constexpr double kRoundDepth_mm = 90;  ///< immersion of the sphere, slightly beyond its equator

/// Returns kAborted with the warnings of a calibration that is too uncertain for a print.
Status check_usable(const v1::Calibration& found) {
  if (found.warnings().empty()) return {};
  std::string texts;
  for (const v1::Warning& warning : found.warnings())
    texts += (texts.empty() ? "" : "; ") + warning.message();
  return fail(Code::kAborted, found.name() + ": " + texts);
}

}  // namespace

LoopRounds::LoopRounds(Program& program, const LoopOptions& options, loop::Body body,
                       const HeldLease& lease)
    : program_(program),
      options_(options),
      body_(std::move(body)),
      lease_(lease),
      inputs_(program.daemon()) {}

fs::path LoopRounds::file(const std::string& name) const {
  return fs::absolute(fs::path(options_.out) / name);
}

void LoopRounds::say(const std::string& what) const {
  if (!program_.json()) std::cerr << "pose " << number_ << ": " << what << std::endl;
}

Result<double> LoopRounds::gripper_mm() const {
  HP_ASSIGN_OR_RETURN(const std::string sight, loop::talk(options_.control, "sight"));
  const auto seen = parse_json(sight).value_or(nullptr);
  if (const auto height_mm = json_number(seen, "gripper_height_mm")) return *height_mm;
  return fail(
      Code::kInvalidArgument,
      options_.control + ": this virtual rig has no camera; add a [camera] to its --scene file");
}

Status LoopRounds::set_object_pose(const Pose& X_GO) const {
  const fs::path held = file("held.json");
  HP_RETURN_IF_ERROR(image::write_artifact(held, loop::pose_json(X_GO)));
  const fs::path mesh = file("sample") / (body_.name + ".obj");
  HP_RETURN_IF_ERROR(loop::talk(options_.control,
                                fmt::format("hang {} {}", loop::quoted(held), loop::quoted(mesh))));
  return {};
}

Status LoopRounds::prepare() {
  HP_RETURN_IF_ERROR(sample::write_sample(body_.name, file("sample")));
  HP_RETURN_IF_ERROR(inputs_.add_model(file("sample") / (body_.name + ".obj"), object_));
  HP_RETURN_IF_ERROR(move_to_view());
  return take_camera();
}

/// Uses the camera calibration that was given; otherwise calibrates the camera first.
Status LoopRounds::take_camera() {
  camera_name_ = calibration_name(options_.camera);
  if (options_.camera.empty()) {
    HP_ASSIGN_OR_RETURN(camera_name_, calibrate_loop_camera(program_, options_.control,
                                                            file("sample"), options_.seed));
    camera_calibration_ = camera_name_;
  } else if (options_.camera == "active") {  // calibrate uses the active one by default
    camera_name_ = "the active one";
  } else if (camera_name_.starts_with("calibrations/")) {
    camera_calibration_ = camera_name_;
  } else {
    HP_ASSIGN_OR_RETURN(camera_, inputs_.add(options_.camera));
  }
  return {};
}

Status LoopRounds::move_to_view() {
  const loop::Truth straight{loop::nominal_pose(body_), {0, 0}, {0, 0}, 1};
  HP_ASSIGN_OR_RETURN(const v1::Rig rig, client::get_rig(program_.daemon()));
  HP_ASSIGN_OR_RETURN(const double now_mm, gripper_mm());
  const double wanted_mm = kAbove_mm - loop::height_mm(body_, straight, 0);
  const double axis_mm = rig.position_mm() + now_mm - wanted_mm;
  HP_RETURN_IF_ERROR(wait_for_motion(
      program_, client::move_rig(program_.daemon(), lease_.id(), axis_mm, std::nullopt)));
  HP_ASSIGN_OR_RETURN(gripper_mm_, gripper_mm());
  return {};
}

Result<v1::Calibration> LoopRounds::calibrate(loop::Round& out) {
  say("capture");
  HP_ASSIGN_OR_RETURN(const v1::Job capture, capture_quietly(program_, options_.seconds));
  v1::Job job;
  v1::CalibrateSpec& spec = *job.mutable_calibrate();
  spec = object_;
  *spec.mutable_pose() = message_of(loop::nominal_pose(body_));
  spec.set_capture_job(capture.name());
  if (camera_) *spec.mutable_camera() = *camera_;
  spec.set_camera_calibration(camera_calibration_);
  spec.set_gripper_mm(gripper_mm_);
  say("calibrate");
  HP_ASSIGN_OR_RETURN(const v1::Job ended, run_quietly(program_, job));
  out.jobs = {capture.name(), ended.name()};
  HP_RETURN_IF_ERROR(fetch(ended.name(), "alignment.png", "alignment", out));
  HP_ASSIGN_OR_RETURN(const v1::Calibration found,
                      client::get_calibration(program_.daemon(), "calibrations/active"));
  if (found.job() != ended.name())
    return fail(
        Code::kAborted,
        "another calibration became active during the loop; run the loop again while nobody "
        "else calibrates");
  HP_RETURN_IF_ERROR(check_usable(found));
  return found;
}

Result<v1::Job> LoopRounds::simulate(const std::string& calibration, loop::Round& out) {
  say("simulate");
  v1::Job job;
  v1::SimulateSpec& spec = *job.mutable_simulate();
  *spec.mutable_mesh() = object_.mesh();
  *spec.mutable_extra_files() = object_.extra_files();
  spec.set_calibration(calibration);
  spec.set_dpi(options_.dpi);
  spec.set_model(options_.simulation.model());
  if (body_.is_round) spec.set_depth_mm(kRoundDepth_mm);
  HP_ASSIGN_OR_RETURN(const v1::Job ended, run_quietly(program_, job));
  out.jobs.push_back(ended.name());
  return ended;
}

Result<v1::Job> LoopRounds::print(const std::string& simulation, loop::Round& out) {
  say("print-image");
  v1::Job job;
  job.mutable_print_image()->set_simulate_job(simulation);
  HP_ASSIGN_OR_RETURN(const v1::Job ended, run_quietly(program_, job));
  out.jobs.push_back(ended.name());
  HP_RETURN_IF_ERROR(fetch(ended.name(), "print.pdf", "print", out));
  return ended;
}

Result<v1::Job> LoopRounds::dip(const std::string& simulation, loop::Round& out) {
  say("dip");
  v1::DipSpec spec;
  spec.set_simulate_job(simulation);
  spec.set_yes_to_all(true);
  HP_ASSIGN_OR_RETURN(const v1::Job job,
                      client::create_dip(program_.daemon(), spec, lease_.id(), {}));
  HP_ASSIGN_OR_RETURN(const v1::Job ended, finish_quietly(program_, job));
  out.jobs.push_back(ended.name());
  return ended;
}

/// Downloads an artifact to a file name that contains the pose's number; pictures are added to the
/// report.
Result<std::string> LoopRounds::fetch(const std::string& job, const std::string& artifact,
                                      const std::string& as, loop::Round& out) const {
  HP_ASSIGN_OR_RETURN(const auto files,
                      download_all(program_.daemon(), job, {artifact}, file("download")));
  const std::string name =
      fmt::format("pose{}-{}{}", number_, as, fs::path(artifact).extension().string());
  std::error_code error;
  fs::rename(files.front().path, file(name), error);
  if (error)
    return fail(
        Code::kInternal,
        file(name).string() + ": cannot be written; check the permissions and the free space");
  if (artifact.ends_with(".png")) out.pictures.push_back(name);
  return name;
}

Result<v1::Job> LoopRounds::run_predict(const v1::PredictSpec& spec) {
  v1::Job job;
  *job.mutable_predict() = spec;
  return run_quietly(program_, job);
}

/// Computes where a film image lands at a pose, with a predict job.
Result<loop::SurfaceMap> LoopRounds::predict(v1::PredictSpec spec, const Pose& pose,
                                             const std::string& as, loop::Round& out) {
  *spec.mutable_pose() = message_of(pose);
  HP_ASSIGN_OR_RETURN(const v1::Job job, run_predict(spec));
  HP_ASSIGN_OR_RETURN(const std::string map, fetch(job.name(), "surface_map.ply", as, out));
  return loop::read_surface_map(file(map));
}

/// Converts the measured positions of the descent to a motion file along the axis's true direction.
Result<v1::InputFile> LoopRounds::driven(const std::string& dip, loop::Round& out) {
  HP_ASSIGN_OR_RETURN(const std::string positions, fetch(dip, "positions.csv", "positions", out));
  std::ifstream from(file(positions));
  std::ostringstream rows;
  rows << "t_s,x_mm,y_mm,z_mm\n";
  double last_s = -1, last_mm = 0;
  for (std::string line; std::getline(from, line);) {
    double time_s = 0, depth_mm = 0;
    char comma = 0;
    std::istringstream words(line);
    if (!(words >> time_s >> comma >> depth_mm) || !line.ends_with(",0,dip")) continue;
    if (depth_mm < last_mm || time_s <= last_s) continue;
    last_s = time_s;
    last_mm = depth_mm;
    const Eigen::Vector2d aside_mm = depth_mm * out.truth.slope;
    rows << time_s << ',' << aside_mm.x() << ',' << aside_mm.y() << ',' << -depth_mm << '\n';
  }
  const fs::path path = file(fmt::format("pose{}-motion.csv", number_));
  HP_RETURN_IF_ERROR(image::write_artifact(path, rows.str()));
  return inputs_.add(path);
}

Status LoopRounds::compare(const v1::Calibration& found, loop::Round& out) const {
  if (found.pose().rotation_wxyz_size() != 4 || found.pose().translation_mm_size() != 3)
    return fail(Code::kInternal, found.name() + " has no pose");
  Pose seen = out.truth.X_GO;  // the true pose during the capture, F
  seen.translation().z() += gripper_mm_;
  const Pose pose = pose_of(found.pose());
  const Eigen::Matrix3d off = pose.linear().transpose() * seen.linear();
  out.turn_off_deg = Eigen::AngleAxisd(off).angle() / loop::kDegree;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : body_.points) box.extend(p);
  const Eigen::Vector3d middle = box.center();
  out.shift_off_mm = (pose * middle - seen * middle).head<2>().norm();
  if (found.has_contact_mm() && found.has_axis_mm())
    out.contact_off_mm =
        found.contact_mm() - found.axis_mm() - loop::height_mm(body_, out.truth, gripper_mm_);
  out.stated_p95_mm = found.error_p95_mm();
  return {};
}

/// Creates the spec of a virtual dip of the film image.
Result<v1::PredictSpec> LoopRounds::landing(const v1::Job& simulation, loop::Round& out) {
  HP_ASSIGN_OR_RETURN(const std::string film, fetch(simulation.name(), "film.png", "film", out));
  v1::PredictSpec spec;
  *spec.mutable_mesh() = object_.mesh();
  *spec.mutable_extra_files() = object_.extra_files();
  spec.set_artifacts(v1::ARTIFACT_SET_MAP);
  spec.set_dpi(options_.dpi);
  spec.set_model(options_.simulation.model());
  if (simulation.simulate().has_depth_mm()) spec.set_depth_mm(simulation.simulate().depth_mm());
  HP_RETURN_IF_ERROR(inputs_.add_to(spec, "film_image", file(film)));
  return spec;
}

/// Computes a picture of the printed object for the report.
Status LoopRounds::show_landed(v1::PredictSpec spec, loop::Round& out) {
  *spec.mutable_pose() = message_of(loop::pose_at_contact(body_, out.truth, gripper_mm_));
  spec.set_artifacts(v1::ARTIFACT_SET_ALL);
  HP_ASSIGN_OR_RETURN(const v1::Job job, run_predict(spec));
  HP_RETURN_IF_ERROR(fetch(job.name(), "predicted.png", "landed", out));
  return {};
}

Status LoopRounds::measure(const v1::Calibration& found, const v1::Job& simulation,
                           const std::string& dip, loop::Round& out) {
  HP_ASSIGN_OR_RETURN(const std::string planned,
                      fetch(simulation.name(), "surface_map.ply", "planned", out));
  HP_ASSIGN_OR_RETURN(const loop::SurfaceMap plan, loop::read_surface_map(file(planned)));
  HP_RETURN_IF_ERROR(fetch(simulation.name(), "predicted.png", "planned", out));
  HP_ASSIGN_OR_RETURN(v1::PredictSpec spec, landing(simulation, out));
  const loop::Truth well;
  loop::Truth upright = out.truth;
  upright.slope.setZero();
  say("predict: as calibrated");
  HP_ASSIGN_OR_RETURN(auto map, predict(spec, pose_of(found.pose()), "as-calibrated", out));
  out.numerics = loop::cross_errors(body_, plan, map, well);
  say("predict: at the true pose");
  HP_ASSIGN_OR_RETURN(
      map, predict(spec, loop::pose_at_contact(body_, upright, gripper_mm_), "upright", out));
  out.calibration = loop::cross_errors(body_, plan, map, well);
  say("predict: with the actual motion");
  HP_ASSIGN_OR_RETURN(*spec.mutable_motion(), driven(dip, out));
  HP_ASSIGN_OR_RETURN(
      map, predict(spec, loop::pose_at_contact(body_, out.truth, gripper_mm_), "landed", out));
  out.motion = loop::cross_errors(body_, plan, map, well);
  out.placement = loop::cross_errors(body_, plan, map, out.truth);
  return number_ == 1 ? show_landed(spec, out) : Status();
}

Result<loop::Round> LoopRounds::round(int index) {
  number_ = index + 1;
  loop::Round out;
  out.truth = loop::draw(body_, options_.seed, index);
  HP_RETURN_IF_ERROR(set_object_pose(out.truth.X_GO));
  if (index > 0) HP_RETURN_IF_ERROR(move_to_view());
  HP_ASSIGN_OR_RETURN(const v1::Calibration found, calibrate(out));
  HP_RETURN_IF_ERROR(compare(found, out));
  HP_ASSIGN_OR_RETURN(const v1::Job simulation, simulate(found.name(), out));
  HP_RETURN_IF_ERROR(print(simulation.name(), out));
  HP_ASSIGN_OR_RETURN(const v1::Job dipped, dip(simulation.name(), out));
  HP_RETURN_IF_ERROR(measure(found, simulation, dipped.name(), out));
  return out;
}

}  // namespace hydroprint::cli
