#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "client/calibration.h"
#include "client/cli/job_io/inputs.h"
#include "client/cli/program/program.h"
#include "client/cli/rig_session/held_lease.h"
#include "client/loop/draws.h"
#include "client/loop/measure.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/job.pb.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

struct LoopOptions {
  std::string object = "board", control, camera, out;
  int poses = 10;
  std::uint32_t seed = 1;
  double dpi = 150, seconds = 2;
  v1::SimulateSpec simulation;  ///< only the name of the film model is used
};

/// Runs the whole loop for each pose in turn: from hanging the object to measuring where the film
/// lands on it.
class LoopRounds {
 public:
  LoopRounds(Program& program, const LoopOptions& options, loop::Body body, const HeldLease& lease);

  /// Creates the object, determines the camera's calibration, and moves the axis to the capture
  /// position.
  [[nodiscard]] Status prepare();
  /// Runs the loop for pose number `index`, counted from 0.
  [[nodiscard]] Result<loop::Round> round(int index);
  /// Returns the name of the camera calibration, or its file.
  [[nodiscard]] const std::string& camera() const { return camera_name_; }

 private:
  [[nodiscard]] std::filesystem::path file(const std::string& name) const;
  [[nodiscard]] Result<double> gripper_mm() const;
  [[nodiscard]] Status set_object_pose(const Pose& X_GO) const;
  Status take_camera();
  Status move_to_view();
  Result<v1::Calibration> calibrate(loop::Round& out);
  Result<v1::Job> simulate(const std::string& calibration, loop::Round& out);
  Result<v1::Job> print(const std::string& simulation, loop::Round& out);
  Result<v1::Job> dip(const std::string& simulation, loop::Round& out);
  Result<std::string> fetch(const std::string& job, const std::string& artifact,
                            const std::string& as, loop::Round& out) const;
  Result<v1::Job> run_predict(const v1::PredictSpec& spec);
  Result<loop::SurfaceMap> predict(v1::PredictSpec spec, const Pose& pose, const std::string& as,
                                   loop::Round& out);
  Result<v1::InputFile> driven(const std::string& dip, loop::Round& out);
  Result<v1::PredictSpec> landing(const v1::Job& simulation, loop::Round& out);
  Status measure(const v1::Calibration& found, const v1::Job& simulation, const std::string& dip,
                 loop::Round& out);
  Status show_landed(v1::PredictSpec spec, loop::Round& out);
  Status compare(const v1::Calibration& found, loop::Round& out) const;
  void say(const std::string& what) const;

  Program& program_;
  const LoopOptions& options_;
  loop::Body body_;
  const HeldLease& lease_;
  Inputs inputs_;
  v1::CalibrateSpec object_;  // mesh and its files
  std::optional<v1::InputFile> camera_;
  std::string camera_calibration_, camera_name_;
  double gripper_mm_ = 0;  // height of the gripper's lower end above the water during the capture
  int number_ = 0;
};

}  // namespace hydroprint::cli
