// Captures with the virtual rig's camera and hydroprint-capture; how calibrations are
// stored, activated and become stale. The worker is the fake one.
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

#include "tests/daemon/api/calibrate_support.h"

namespace hydroprint::tests {
namespace {

constexpr const char* kMesh = "sleep 0";

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The frames.json files that a spec refers to.
std::set<std::string> frame_listings(const nlohmann::json& spec) {
  std::set<std::string> out;
  for (const auto& file : spec.at("frames")) {
    const std::string name = file.at("name");
    if (name.ends_with("/frames.json")) out.insert(name);
  }
  return out;
}

class CalibrateApi : public CameraTest {
 protected:
  CalibrateApi() {
    start_rig();
    start_daemon(DaemonProcess::fake(), kPatience_s);
  }

  static constexpr int kPatience_s = 20;  ///< timeout for camera operations on a busy machine

  /// Runs a calibrate job and returns its calibration.
  v1::Calibration calibrated(const v1::Job& capture, const std::string& mesh = kMesh) {
    const v1::Job job = done(create(calibrate_of(capture, mesh)));
    EXPECT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
    EXPECT_EQ(all().front().job(), job.name());
    return all().front();
  }
  /// Homes the rig, captures at the capture position, and returns the calibration from this
  /// capture.
  v1::Calibration calibrated() {
    ann->make_ready();
    ann->go_to(kAxis_mm);
    return calibrated(captured());
  }
  v1::Job simulate_by(const std::string& calibration, const std::string& mesh = kMesh) {
    v1::Job out = simulate_request(ann->upload(mesh), "body.obj").job();
    out.mutable_simulate()->set_calibration(calibration);
    return out;
  }
};

TEST_F(CalibrateApi, CaptureStoresCameraFrames) {
  const v1::Job job = captured(0.5);
  EXPECT_EQ(job.display_name(), "capture");
  EXPECT_EQ(job.progress_fraction(), 1);
  const auto listing = nlohmann::json::parse(file(job, "frames.json"));
  EXPECT_GE(listing["frames"].size(), 1U);
  EXPECT_EQ(listing["source"]["uri"], rig->camera());
  EXPECT_TRUE(has(file(job, "frame-0001.png"), "PNG"));
  v1::RetryJobRequest retry;
  retry.set_name(job.name());
  v1::Job again;
  const auto status = ann->jobs->RetryJob(ann->context().get(), retry, &again);
  EXPECT_EQ(error_info(status).reason(), "STATE_FORBIDS");
  EXPECT_EQ(refusal(capture_of(21)).reason(), "SPEC_INVALID");
}

TEST_F(CalibrateApi, CameraFaultsAreNamed) {
  const auto reason = [&](const std::string& fault, bool while_it_runs) {
    if (!while_it_runs) rig->act(fault);
    const v1::Job job = create(capture_of(15));
    if (while_it_runs) {
      ann->wait(job.name(), [](const v1::Job& now) { return now.progress_fraction() > 0; });
      rig->act(fault);
    }
    const v1::Job ended = done(job);
    rig->act("clear");
    EXPECT_EQ(ended.state(), v1::Job::FAILED);
    EXPECT_FALSE(ended.error().message().empty());
    return v1::ErrorReason_Name(ended.error().reason());
  };
  EXPECT_EQ(reason("camera gone", false), "CAMERA_NOT_FOUND");
  EXPECT_EQ(reason("camera gone", true), "CAMERA_GONE");
  EXPECT_EQ(reason("camera frozen", true), "CAMERA_FROZEN");
  EXPECT_EQ(reason("camera black", true), "CAMERA_BLACK");
  EXPECT_EQ(captured().state(), v1::Job::SUCCEEDED) << "the camera works again";
}

TEST_F(CalibrateApi, HangingCameraFailsTheCapture) {
  daemon.reset();
  start_daemon(DaemonProcess::fake(), 2);
  rig->act("camera hung");
  const v1::Job job = done(create(capture_of(1)));
  EXPECT_EQ(job.error().reason(), v1::CAMERA_STALLED) << job.error().message();
}

TEST_F(CalibrateApi, CapturesRunOneAtATimeAndCanBeCancelled) {
  const v1::Job job = create(capture_of(20));
  EXPECT_EQ(job.state(), v1::Job::RUNNING);
  EXPECT_EQ(refusal(capture_of(1)).reason(), "STATE_FORBIDS");
  EXPECT_EQ(ann->queue().running_jobs_size(), 0) << "a capture occupies no worker";
  ann->wait(job.name(), [](const v1::Job& now) { return now.progress_fraction() > 0; });
  ann->cancel(job.name());
  EXPECT_EQ(done(job).state(), v1::Job::CANCELLED);
  EXPECT_EQ(captured().state(), v1::Job::SUCCEEDED);
}

TEST_F(CalibrateApi, NoCaptureWhileTheAxisMoves) {
  ann->make_ready();
  ASSERT_TRUE(ann->move_to(kAxis_mm, 2).ok());
  EXPECT_EQ(refusal(capture_of(1)).reason(), "MOTION_IN_PROGRESS");
  EXPECT_TRUE(ann->stop().ok());
}

TEST_F(CalibrateApi, KillingTheDaemonEndsTheCapture) {
  if (!proc_is_mounted()) GTEST_SKIP() << kNeedsProc;
  const v1::Job job = create(capture_of(20));
  ann->wait(job.name(), [](const v1::Job& now) { return now.progress_fraction() > 0; });
  const auto processes = daemon->workers();
  ASSERT_EQ(processes.size(), 1U);
  daemon->kill();
  EXPECT_TRUE(wait_until([&] { return ::kill(processes.front(), 0) != 0; }));
  daemon->start();
  connect();
  EXPECT_EQ(ann->job(job.name()).state(), v1::Job::INTERRUPTED);
  EXPECT_EQ(captured().state(), v1::Job::SUCCEEDED);
}

TEST_F(CalibrateApi, CalibrationHoldsThePoseAndTheAxisPosition) {
  ann->make_ready();
  ann->go_to(kAxis_mm);
  const v1::Job capture = captured();
  const v1::Calibration found = calibrated(capture);
  EXPECT_EQ(found.kind(), v1::Calibration::OBJECT);
  EXPECT_EQ(found.display_name(), "calibrate " + capture.name());
  EXPECT_EQ(found.owner(), "ann");
  EXPECT_TRUE(found.active());
  EXPECT_TRUE(found.has_create_time() && found.has_capture_time());
  EXPECT_LT(found.capture_time().seconds(), found.create_time().seconds() + 1);
  EXPECT_EQ(found.stale_size(), 0);
  EXPECT_EQ(found.pose().translation_mm(0), 3);
  EXPECT_EQ(found.covariance_size(), 36);
  EXPECT_EQ(found.error_p95_mm(), 0.4);
  ASSERT_EQ(found.markers_size(), 2);
  EXPECT_EQ(found.markers(1).why_not(), "hidden");
  EXPECT_EQ(found.from_nominal_pose(0), "turn");
  ASSERT_EQ(found.warnings_size(), 1);
  EXPECT_TRUE(has(found.warnings(0).message(), "from the nominal pose: turn"));
  EXPECT_EQ(found.warnings(0).code(), v1::Warning::POSE_UNCONSTRAINED);
  EXPECT_EQ(found.warnings(0).where().resource(), found.name());
  EXPECT_EQ(found.symmetries(0), "any turn");
  EXPECT_EQ(found.water_z_mm(), 0.25);
  EXPECT_NEAR(found.axis_mm(), kAxis_mm, 0.2);
  EXPECT_NEAR(found.contact_mm(), found.axis_mm() + 10.5, 1e-9) << "positive is down";
  EXPECT_EQ(ann->download(found.picture()), "picture of body.obj");
  const auto spec = given_spec(ann->download(found.job() + "/artifacts/spec.json"));
  EXPECT_EQ(frame_listings(spec), std::set<std::string>{"frames/frames.json"});
  EXPECT_EQ(spec["layout"]["name"], "rig/layout.toml");
  EXPECT_NEAR(spec["gripperMm"].get<double>(), water_mm - found.axis_mm(), 1e-9);
  EXPECT_EQ(ann->job(found.job()).calibrate().capture_job(), capture.name());
  EXPECT_NEAR(ann->job(found.job()).calibrate().gripper_mm(), water_mm - found.axis_mm(), 1e-9);
}

TEST_F(CalibrateApi, CalibrationOutlivesTheDaemonAndItsCapture) {
  const v1::Job capture = captured();
  const v1::Calibration found = calibrated(capture);
  v1::DeleteJobRequest deletion;
  google::protobuf::Empty nothing;
  deletion.set_name(found.job());
  EXPECT_EQ(reason_of(ann->jobs->DeleteJob(ann->context().get(), deletion, &nothing)),
            "STATE_FORBIDS");
  deletion.set_name(capture.name());
  EXPECT_TRUE(ann->jobs->DeleteJob(ann->context().get(), deletion, &nothing).ok());
  daemon->kill();
  daemon->start();
  connect();
  EXPECT_EQ(get(found.name()).SerializeAsString(), found.SerializeAsString());
  EXPECT_EQ(get("calibrations/active").name(), found.name());
  EXPECT_EQ(ann->download(found.picture()), "picture of body.obj");
  v1::RetryJobRequest retry;
  retry.set_name(found.job());
  v1::Job again;
  ASSERT_TRUE(ann->jobs->RetryJob(ann->context().get(), retry, &again).ok());
  EXPECT_EQ(done(again).state(), v1::Job::SUCCEEDED) << "the frames of the capture still exist";
  EXPECT_EQ(all().size(), 2U);
}

TEST_F(CalibrateApi, FailedOrOtherJobsLeaveNoCalibration) {
  const v1::Job capture = captured();
  const auto reason = [&](const std::string& mesh) {
    const v1::Job job = done(create(calibrate_of(capture, mesh)));
    EXPECT_EQ(job.state(), v1::Job::FAILED);
    return v1::ErrorReason_Name(job.error().reason());
  };
  EXPECT_EQ(reason("garbage"), "WORKER_UNUSABLE");
  EXPECT_EQ(reason("reason MIRRORED\nexit 3 the mesh is its mirror image"), "MIRRORED");
  EXPECT_EQ(reason("reason MADE_UP\nexit 3 words"), "INPUT_REFUSED");
  const v1::Job slow = create(calibrate_of(capture, "sleep 30"));
  ann->wait_for(slow.name(), v1::Job::RUNNING);
  ann->cancel(slow.name());
  EXPECT_EQ(done(slow).state(), v1::Job::CANCELLED);
  const v1::Job lost = create(calibrate_of(capture, "sleep 3"));
  ann->wait_for(lost.name(), v1::Job::RUNNING);
  daemon->kill();
  daemon->start();
  connect();
  EXPECT_EQ(all().size(), 0U);
  EXPECT_EQ(done(lost).state(), v1::Job::SUCCEEDED) << "the interrupted job is queued again";
  EXPECT_EQ(all().size(), 1U);
}

TEST_F(CalibrateApi, ActiveLensIsTheDefault) {
  const v1::Job capture = captured();
  v1::Job wanted;
  for (int i = 0; i < 2; ++i) wanted.mutable_calibrate_camera()->add_capture_jobs(capture.name());
  const v1::Job job = done(create(wanted));
  ASSERT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
  EXPECT_EQ(frame_listings(given_spec(file(job, "spec.json"))),
            (std::set<std::string>{"view1/frames.json", "view2/frames.json"}));
  const v1::Calibration lens = all().front();
  EXPECT_EQ(lens.kind(), v1::Calibration::CAMERA);
  EXPECT_EQ(lens.views(), 12);
  EXPECT_TRUE(lens.active());
  const v1::Calibration found = calibrated(capture);
  EXPECT_EQ(given_spec(ann->download(found.job() + "/artifacts/spec.json"))["camera"]["name"],
            "rig/camera.json");
  EXPECT_EQ(ann->job(found.job()).calibrate().camera_calibration(), lens.name());
  EXPECT_TRUE(get(lens.name()).active()) << "each kind has its own active calibration";
  v1::Job other = calibrate_of(capture, kMesh);
  other.mutable_calibrate()->set_camera_calibration(found.name());
  EXPECT_EQ(refusal(other).reason(), "SPEC_INVALID")
      << "a calibration of an object is not one of a lens";
  other.mutable_calibrate()->set_camera_calibration("calibrations/99");
  EXPECT_EQ(refusal(other).reason(), "CALIBRATION_MISSING");
  EXPECT_EQ(refusal(simulate_by(lens.name())).reason(), "SPEC_INVALID")
      << "a calibration of a lens is not one of an object";
}

TEST_F(CalibrateApi, SimulateUsesPoseFilmAndScaleOfTheCalibration) {
  v1::Job wanted = calibrate_of(captured(), kMesh);
  wanted.mutable_calibrate()->set_scale(2.5);
  wanted.mutable_calibrate()->set_film("polygon:film.json");
  auto& polygon = *wanted.mutable_calibrate()->add_extra_files();
  polygon.set_name("film.json");
  polygon.set_asset(ann->upload("[[0,0],[9,0],[0,9]]"));
  ASSERT_EQ(done(create(wanted)).state(), v1::Job::SUCCEEDED);
  const v1::Job job = done(create(simulate_by("calibrations/active")));
  ASSERT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
  EXPECT_EQ(job.simulate().calibration(), all().front().name());
  EXPECT_EQ(job.simulate().pose().translation_mm(1), -2);
  const auto spec = given_spec(file(job, "report.json"));
  EXPECT_EQ(spec["scale"], 2.5);
  EXPECT_EQ(spec["film"], "polygon:film.json");
  EXPECT_EQ(spec["pose"]["translationMm"][1], -2);
  EXPECT_EQ(spec["pose"]["errorP95Mm"], 0.4) << "the worker warns of an uncertain pose";
  EXPECT_EQ(spec["pose"]["fromNominalPose"][0], "turn");
  v1::Job paper;
  paper.mutable_print_image()->set_simulate_job(job.name());
  const auto printed = given_spec(file(done(create(paper)), "spec.json"));
  EXPECT_EQ(printed["pose"]["fromNominalPose"][0], "turn");
  v1::Job twice = simulate_by("calibrations/active");
  twice.mutable_simulate()->set_scale(2.5);
  EXPECT_EQ(refusal(twice).reason(), "SPEC_INVALID");
  const auto other = refusal(simulate_by(job.simulate().calibration(), "sleep 0\n"));
  EXPECT_EQ(other.reason(), "CALIBRATION_STALE");
  EXPECT_EQ(other.metadata().at("why"), "OTHER_OBJECT");
  EXPECT_EQ(refusal(simulate_by("calibrations/99")).reason(), "CALIBRATION_MISSING");
  EXPECT_EQ(refusal(simulate_by("3")).reason(), "ID_INVALID");
  EXPECT_TRUE(remove(job.simulate().calibration()).ok());
  EXPECT_EQ(refusal(simulate_by("calibrations/active")).reason(), "CALIBRATION_MISSING");
}

TEST_F(CalibrateApi, StaleCalibrationIsRefusedUnlessAllowed) {
  const v1::Calibration found = calibrated();
  EXPECT_EQ(done(create(simulate_by(found.name()))).state(), v1::Job::SUCCEEDED);
  ann->go_to(kAxis_mm + 2);
  EXPECT_EQ(get(found.name()).stale(0), v1::Calibration::MOVED);
  v1::Job wanted = simulate_by(found.name());
  EXPECT_EQ(refusal(wanted).reason(), "CALIBRATION_STALE");
  EXPECT_EQ(refusal(wanted).metadata().at("why"), "MOVED");
  wanted.mutable_simulate()->set_allow_stale_calibration(true);
  EXPECT_EQ(refusal(wanted).reason(), "");
  ann->go_to(kAxis_mm);
  EXPECT_EQ(get(found.name()).stale_size(), 0) << "the axis is back at its position";
  ASSERT_TRUE(ann->home().ok());
  ASSERT_TRUE(ann->becomes(v1::Rig::IDLE, 30));
  ann->go_to(kAxis_mm);
  EXPECT_EQ(get(found.name()).stale(0), v1::Calibration::HOMED);
  daemon->terminate();
  daemon->start();
  const std::string lease = ann->lease_id;
  connect();
  ann->lease_id = lease;
  EXPECT_EQ(get(found.name()).stale(0), v1::Calibration::HOMED);
  ann->make_ready();
  ann->go_to(kAxis_mm);
  EXPECT_EQ(get(found.name()).stale(0), v1::Calibration::HOMED) << "still stale after homing again";
}

TEST_F(CalibrateApi, DipUsesTheMeasuredFirstContact) {
  const v1::Calibration found = calibrated();
  v1::Job wanted;
  *wanted.mutable_dip() = short_dip();
  wanted.mutable_dip()->set_calibration("calibrations/active");
  const v1::Job job = create(wanted);
  EXPECT_EQ(job.dip().calibration(), found.name());
  EXPECT_TRUE(has(job.dip_status().warnings(0).message(), "from the nominal pose: turn"));
  EXPECT_TRUE(has(job.dip_status().instruction(), "accept a misplaced print"))
      << job.dip_status().instruction();
  const v1::Job waiting = ann->guide_to(job.name(), v1::DipStatus::FIND_CONTACT);
  EXPECT_TRUE(has(waiting.dip_status().instruction(), found.name()))
      << waiting.dip_status().instruction();
  EXPECT_EQ(job.dip_status().contact_mm(), found.contact_mm()) << "known from the beginning";
  EXPECT_EQ(waiting.dip_status().contact_mm(), found.contact_mm());
  const v1::Job ended = done(ann->guide_to(job.name(), v1::DipStatus::RETRACT));
  ASSERT_EQ(ended.state(), v1::Job::SUCCEEDED) << ended.error().message();
  EXPECT_EQ(ended.dip_status().contact_mm(), found.contact_mm());
  const auto report = ann->report(job.name());
  EXPECT_EQ(report["calibration"], found.name());
  EXPECT_NEAR(report["axis"]["bottom_mm"], found.contact_mm() + 5, 1e-9);
  EXPECT_NEAR(report["depth_reached_mm"], 5, 0.2);
  ann->go_to(kAxis_mm);
  const auto again = refusal(wanted);
  EXPECT_EQ(again.reason(), "CALIBRATION_STALE");
  EXPECT_EQ(again.metadata().at("why"), "DIPPED");
  EXPECT_EQ(refusal(simulate_by(found.name())).metadata().at("why"), "DIPPED");
  wanted.mutable_dip()->set_allow_stale_calibration(true);
  const v1::Job told = create(wanted);
  EXPECT_TRUE(has(told.dip_status().warnings(0).message(), "dipped")) << told.ShortDebugString();
  const v1::Job looks = ann->guide_to(told.name(), v1::DipStatus::FIND_CONTACT);
  EXPECT_TRUE(has(looks.dip_status().instruction(), "jog down"))
      << "with a stale calibration, the operator has to find first contact";
  ann->cancel(told.name());
}

TEST_F(CalibrateApi, HomingDuringADipInvalidatesFirstContact) {
  const v1::Calibration found = calibrated();
  v1::Job wanted;
  *wanted.mutable_dip() = short_dip();
  wanted.mutable_dip()->set_calibration(found.name());
  const v1::Job job = create(wanted);
  ann->guide_to(job.name(), v1::DipStatus::FIND_CONTACT);
  ASSERT_TRUE(ann->home().ok());
  ASSERT_TRUE(ann->becomes(v1::Rig::IDLE, 30));
  EXPECT_EQ(reason_of(ann->confirm(job.name(), v1::DipStatus::FIND_CONTACT)), "CALIBRATION_STALE");
  ann->cancel(job.name());
  EXPECT_EQ(done(job).state(), v1::Job::CANCELLED);
}

TEST_F(CalibrateApi, CalibrationCanBeEnteredByHand) {
  v1::CreateCalibrationRequest request;
  v1::Calibration& entered = *request.mutable_calibration();
  entered.mutable_mesh()->set_name("body.obj");
  entered.mutable_mesh()->set_asset(ann->upload(kMesh));
  entered.set_film("100x120");
  entered.set_active(false);
  entered.set_job("jobs/1");
  v1::Calibration made;
  const auto enter = [&] {
    return calibrations->CreateCalibration(ann->context().get(), request, &made);
  };
  EXPECT_EQ(reason_of(enter()), "SPEC_INVALID") << "a calibration without a pose is refused";
  for (const double x : {1.0, 0.0, 0.0, 0.0}) entered.mutable_pose()->add_rotation_wxyz(x);
  for (const double x : {1.0, 2.0, 0.0}) entered.mutable_pose()->add_translation_mm(x);
  entered.mutable_pose()->set_error_p95_mm(3);  // as in the pose file of a calibration elsewhere
  ASSERT_TRUE(enter().ok());
  EXPECT_EQ(made.error_p95_mm(), 3);
  EXPECT_EQ(made.warnings_size(), 1);
  EXPECT_EQ(made.job(), "") << "read-only fields are ignored";
  EXPECT_TRUE(made.active());
  EXPECT_EQ(made.scale(), 1);
  EXPECT_FALSE(made.has_contact_mm());
  const v1::Job job = done(create(simulate_by("calibrations/active")));
  EXPECT_EQ(given_spec(file(job, "report.json"))["film"], "100x120");
  entered.mutable_mesh()->set_asset("assets/" + std::string(64, 'b'));
  EXPECT_EQ(reason_of(enter()), "ASSET_MISSING");
}

TEST_F(CalibrateApi, WithoutACameraCapturesAreRefused) {
  daemon.reset();
  auto options = DaemonProcess::fake();
  daemon = std::make_unique<DaemonProcess>(folder.path(), options);
  connect();
  EXPECT_EQ(refusal(capture_of(1)).reason(), "CAMERA_MISSING");
}

}  // namespace
}  // namespace hydroprint::tests
