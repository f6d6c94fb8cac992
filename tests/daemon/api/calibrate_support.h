#pragma once

#include <memory>
#include <string>

#include "hydroprint/v1/calibration_service.grpc.pb.h"
#include "tests/daemon/api/rig_support.h"
#include "tests/support/paths.h"

namespace hydroprint::tests {

/// A virtual rig with a camera and a high water level, and a daemon connected to both.
class CameraTest : public ::testing::Test {
 protected:
  static constexpr double kAxis_mm = 20;  ///< axis position for captures

  void start_rig(const std::string& object = "",
                 const std::vector<std::pair<std::string, std::string>>& files = {}) {
    VirtualRigOptions options;
    options.scene =
        object + "[water]\nat_mm = " + std::to_string(water_mm) + "\n[camera]\nseed = 7\n";
    options.files = files;
    rig = std::make_unique<VirtualRig>(options);
  }
  void start_daemon(DaemonProcess::Options options, int patience_s) {
    options.extra = rig->section() + "[camera]\ndevice = \"" + rig->camera() +
                    "\"\npatience_s = " + std::to_string(patience_s) + "\nlayout = \"" +
                    testing::source_path("deploy/rig_layout.toml.example") +
                    "\"\ngripper_water_mm = " + std::to_string(water_mm) + "\n";
    daemon = std::make_unique<DaemonProcess>(folder.path(), options);
    connect();
  }
  /// Connects to the daemon; needed again after a restart.
  void connect() {
    ann = std::make_unique<RigClient>(daemon->address(), "ann");
    calibrations = v1::CalibrationService::NewStub(ann->channel);
  }

  v1::Job create(const v1::Job& wanted) {
    v1::CreateJobRequest request;
    *request.mutable_job() = wanted;
    request.set_lease_id(ann->lease_id);
    v1::Job job;
    const grpc::Status status = ann->create(request, job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job;
  }
  /// Details of the error with which a job is refused; empty if it is accepted.
  google::rpc::ErrorInfo refusal(const v1::Job& wanted) {
    v1::CreateJobRequest request;
    *request.mutable_job() = wanted;
    request.set_lease_id(ann->lease_id);
    v1::Job job;
    return error_info(ann->create(request, job));
  }
  v1::Job done(const v1::Job& job) { return ann->wait_for_end(job.name()); }

  static v1::Job capture_of(double seconds) {
    v1::Job out;
    out.mutable_capture()->set_seconds(seconds);
    return out;
  }
  v1::Job captured(double seconds = 0.2) {
    const v1::Job job = done(create(capture_of(seconds)));
    EXPECT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
    return job;
  }
  v1::Job calibrate_of(const v1::Job& capture, const std::string& mesh) {
    v1::Job out;
    out.mutable_calibrate()->set_capture_job(capture.name());
    out.mutable_calibrate()->mutable_mesh()->set_name("body.obj");
    out.mutable_calibrate()->mutable_mesh()->set_asset(ann->upload(mesh));
    return out;
  }

  std::vector<v1::Calibration> all() {
    v1::ListCalibrationsResponse reply;
    EXPECT_TRUE(calibrations->ListCalibrations(ann->context().get(), {}, &reply).ok());
    return {reply.calibrations().begin(), reply.calibrations().end()};
  }
  v1::Calibration get(const std::string& name) {
    v1::GetCalibrationRequest request;
    request.set_name(name);
    v1::Calibration reply;
    const auto status = calibrations->GetCalibration(ann->context().get(), request, &reply);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return reply;
  }
  grpc::Status remove(const std::string& name) {
    v1::DeleteCalibrationRequest request;
    request.set_name(name);
    google::protobuf::Empty reply;
    return calibrations->DeleteCalibration(ann->context().get(), request, &reply);
  }
  std::string file(const v1::Job& job, const std::string& name) {
    return ann->download(job.name() + "/artifacts/" + name);
  }

  double water_mm = 90;  ///< axis position at which the gripper touches the water
  TemporaryFolder folder;
  std::unique_ptr<VirtualRig> rig;
  std::unique_ptr<DaemonProcess> daemon;
  std::unique_ptr<RigClient> ann;
  std::unique_ptr<v1::CalibrationService::Stub> calibrations;
};

}  // namespace hydroprint::tests
