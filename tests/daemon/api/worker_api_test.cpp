// Jobs whose workers misbehave, and the main round trip with the real worker.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <sstream>
#include <thread>

#include "daemon/confine/landlock.h"
#include "hydroprint/v1/calibration_service.grpc.pb.h"
#include "tests/daemon/api/support.h"

namespace hydroprint::tests {
namespace {

using namespace std::string_literals;

class Workers : public ::testing::Test {
 protected:
  void start(const DaemonProcess::Options& options) {
    daemon = std::make_unique<DaemonProcess>(folder.path(), options);
    client = std::make_unique<Client>(daemon->address());
  }
  v1::Job run(const std::string& mesh) {
    return client->wait_for_end(client->simulate(mesh).name());
  }
  void expect_failed(const std::string& mesh, int code, const std::string& reason) {
    const v1::Job job = run(mesh);
    EXPECT_EQ(job.state(), v1::Job::FAILED);
    EXPECT_EQ(job.error().code(), code) << job.error().message();
    EXPECT_EQ(v1::ErrorReason_Name(job.error().reason()), reason) << job.error().message();
    EXPECT_FALSE(job.error().message().empty());
    EXPECT_EQ(job.error().message().find('\n'), std::string::npos);
    v1::ListArtifactsRequest list;
    list.set_parent(job.name());
    v1::ListArtifactsResponse page;
    ASSERT_TRUE(client->artifacts->ListArtifacts(client->context().get(), list, &page).ok());
    EXPECT_EQ(page.artifacts_size(), 0);
    EXPECT_FALSE(std::filesystem::exists(daemon->state() / "artifacts" / job.name().substr(5)));
  }
  pid_t wait_for_worker() {
    for (int i = 0; i < 1000; ++i) {
      if (const auto pids = daemon->workers(); !pids.empty()) return pids.front();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    throw std::runtime_error("no worker process appeared");
  }

  TemporaryFolder folder;
  std::unique_ptr<DaemonProcess> daemon;
  std::unique_ptr<Client> client;
};

TEST_F(Workers, EachKindOfFailureHasItsError) {
  start(DaemonProcess::fake());
  expect_failed("exit 3 spot.obj:7: not a number; fix the line", grpc::INVALID_ARGUMENT,
                "INPUT_REFUSED");
  EXPECT_EQ(client->job("jobs/1").error().message(), "spot.obj:7: not a number; fix the line");
  EXPECT_EQ(client->job("jobs/1").error().exit_status(), 3);
  expect_failed("field dpi\nreason MIRRORED\nexit 3 too large", grpc::INVALID_ARGUMENT, "MIRRORED");
  EXPECT_EQ(client->job("jobs/2").error().message(), "too large");
  EXPECT_EQ(client->job("jobs/2").error().field(), "simulate.dpi");
  expect_failed("exit 2 not built yet", grpc::INVALID_ARGUMENT, "INPUT_REFUSED");
  expect_failed("exit 4 it diverged", grpc::INTERNAL, "COMPUTATION_FAILED");
  expect_failed("exit 77 what", grpc::INTERNAL, "COMPUTATION_FAILED");
  expect_failed("crash", grpc::INTERNAL, "WORKER_KILLED");
  expect_failed("nothing", grpc::INTERNAL, "WORKER_UNUSABLE");
}

TEST_F(Workers, OutputOtherThanPlainFilesIsRefused) {
  start(DaemonProcess::fake());
  const auto others = folder.path() / "others";
  std::filesystem::create_directory(others);
  std::ofstream(others / "key.pem") << "secret";
  for (const std::string& output : {"link"s, "pipe"s, "twice"s, "deep 500"s,
                                    "elsewhere " + others.string(), "elsewhere out"s}) {
    expect_failed(output, grpc::INTERNAL, "WORKER_UNUSABLE");
  }
  EXPECT_EQ(content(others / "key.pem"), "secret");
  EXPECT_TRUE(wait_until([&] { return std::filesystem::is_empty(daemon->state() / "runs"); }));
  EXPECT_EQ(run("").state(), v1::Job::SUCCEEDED);
}

TEST_F(Workers, UnusableReportFailsItsJobAndTheDaemonGoesOn) {
  start(DaemonProcess::fake());
  for (const auto& [fault, words] :
       std::vector<std::pair<std::string, std::string>>{{"garbage", "report.json, line 1"},
                                                        {"type", "run.threads"},
                                                        {"enum", "MADE_UP"},
                                                        {"nan", "must be a finite number"},
                                                        {"large", "larger than 4 MiB"},
                                                        {"missing", "missing"}}) {
    const v1::Job job = run("report " + fault);
    EXPECT_EQ(job.state(), v1::Job::FAILED) << fault;
    EXPECT_EQ(job.error().reason(), v1::WORKER_UNUSABLE) << fault;
    EXPECT_NE(job.error().message().find(words), std::string::npos) << job.error().message();
  }
  EXPECT_EQ(run("# nothing wrong").state(), v1::Job::SUCCEEDED);
}

TEST_F(Workers, ReportIsReturnedAsAMessage) {
  start(DaemonProcess::fake());
  const v1::Job job = run("warn it tears");
  v1::GetJobReportRequest request;
  v1::JobReport report;
  const auto ask = [&] {
    return client->jobs->GetJobReport(client->context().get(), request, &report);
  };
  request.set_name(job.name());
  ASSERT_TRUE(ask().ok());
  EXPECT_EQ(report.simulate().run().verb(), "simulate");
  ASSERT_EQ(report.simulate().run().warnings_size(), 1);
  EXPECT_EQ(report.simulate().run().warnings(0).code(), v1::Warning::FILM_TORN);
  EXPECT_TRUE(report.simulate().run().warnings(0).where().surface());
  const auto file = daemon->state() / "artifacts" / job.name().substr(5) / "report.json";
  std::ofstream(file) << "damaged";
  EXPECT_EQ(error_info(ask()).reason(), "ARTIFACT_DAMAGED");
  request.set_name(run("exit 4 broken").name());
  EXPECT_EQ(error_info(ask()).reason(), "ARTIFACT_NOT_FOUND");
}

TEST_F(Workers, KilledWorkerFailsOnlyItsJob) {
  if (!proc_is_mounted()) GTEST_SKIP() << kNeedsProc;
  start(DaemonProcess::fake());
  const v1::Job job = client->simulate("sleep 60");
  client->wait_for(job.name(), v1::Job::RUNNING);
  ::kill(wait_for_worker(), SIGKILL);
  const v1::Job ended = client->wait_for_end(job.name());
  EXPECT_EQ(ended.state(), v1::Job::FAILED);
  EXPECT_EQ(ended.error().reason(), v1::WORKER_KILLED);
  EXPECT_EQ(ended.error().signal(), SIGKILL);
  EXPECT_EQ(run("").state(), v1::Job::SUCCEEDED);
}

TEST_F(Workers, RunAtLowerPriorityThanTheDaemon) {
  if (!proc_is_mounted()) GTEST_SKIP() << kNeedsProc;
  start(DaemonProcess::fake());
  client->simulate("sleep 60");
  const pid_t worker = wait_for_worker();
  // Until exec, the new process is a copy of the daemon and has its priority.
  const int least = std::max(10, ::getpriority(PRIO_PROCESS, 0));
  for (int i = 0; i < 500 && ::getpriority(PRIO_PROCESS, worker) < least; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(::getpriority(PRIO_PROCESS, worker), least);
  EXPECT_EQ(::getpriority(PRIO_PROCESS, daemon->pid()), ::getpriority(PRIO_PROCESS, 0));
}

TEST_F(Workers, CancellingARunningJobEndsItsWorker) {
  if (!proc_is_mounted()) GTEST_SKIP() << kNeedsProc;
  start(DaemonProcess::fake());
  const v1::Job job = client->simulate("sleep 60");
  client->wait_for(job.name(), v1::Job::RUNNING);
  wait_for_worker();
  EXPECT_EQ(client->cancel(job.name()).state(), v1::Job::CANCELLING);
  EXPECT_EQ(client->wait_for_end(job.name()).state(), v1::Job::CANCELLED);
  EXPECT_TRUE(daemon->workers().empty());
  EXPECT_EQ(client->cancel(job.name()).state(), v1::Job::CANCELLED);
}

TEST_F(Workers, StubbornWorkerIsKilled) {
  if (!proc_is_mounted()) GTEST_SKIP() << kNeedsProc;
  start(DaemonProcess::fake());
  const v1::Job job = client->simulate("stubborn");
  client->wait(job.name(), [](const v1::Job& now) { return now.phase() == "velocity"; });
  client->cancel(job.name());
  EXPECT_EQ(client->wait_for_end(job.name()).state(), v1::Job::CANCELLED);
  EXPECT_TRUE(daemon->workers().empty());
}

TEST_F(Workers, QueuedJobIsCancelledAtOnce) {
  start(DaemonProcess::fake());
  client->pause();
  const v1::Job job = client->simulate("sleep 60");
  EXPECT_EQ(client->cancel(job.name()).state(), v1::Job::CANCELLED);
}

// Sanitizers reserve far more memory than any limit, so the test is skipped with them. (With
// messages, ThreadSanitizer is known by libstdc++'s macro only, see proto/CMakeLists.txt.)
#if !defined(__SANITIZE_ADDRESS__) && !defined(_GLIBCXX_TSAN)
TEST_F(Workers, MemoryLimitEndsOnlyTheJob) {
  auto options = DaemonProcess::fake();
  options.memory_mib = 128;
  start(options);
  expect_failed("eat", grpc::RESOURCE_EXHAUSTED, "MEMORY_LIMIT");
  EXPECT_EQ(run("").state(), v1::Job::SUCCEEDED);
}
#endif

TEST_F(Workers, TimeLimitEndsTheJob) {
  auto options = DaemonProcess::fake();
  options.time_limit_s = 1;
  start(options);
  expect_failed("sleep 60", grpc::RESOURCE_EXHAUSTED, "TIME_LIMIT");
}

TEST_F(Workers, FileLimitEndsTheJob) {
  auto options = DaemonProcess::fake();
  options.file_mib = 8;
  start(options);
  expect_failed("huge", grpc::RESOURCE_EXHAUSTED, "OUTPUT_LIMIT");
}

// Hashing the files would take an hour.
TEST_F(Workers, SparseFilesAreRefusedAtOnce) {
  auto options = DaemonProcess::fake();
  options.file_mib = 4096;
  start(options);
  expect_failed("sparse 400 4", grpc::RESOURCE_EXHAUSTED, "OUTPUT_LIMIT");
}

TEST_F(Workers, PublishingEndsWithTheDaemonAndOnCancel) {
  if (!proc_is_mounted()) GTEST_SKIP() << kNeedsProc;
  auto options = DaemonProcess::fake();
  options.file_mib = 1 << 20;
  start(options);
  const std::string job = client->simulate("sparse 1 1024").name();
  const auto is_publishing = [&](const std::string& attempt) {
    const auto report = daemon->state() / "runs" / attempt / "work/out/report.json";
    return std::filesystem::exists(report) && daemon->workers().empty();
  };
  ASSERT_TRUE(wait_until([&] { return is_publishing("1-1"); }, 60));
  EXPECT_EQ(client->job(job).state(), v1::Job::RUNNING);
  EXPECT_EQ(daemon->terminate(), 0);
  daemon->start();
  client = std::make_unique<Client>(daemon->address());
  ASSERT_TRUE(wait_until([&] { return is_publishing("1-2"); }, 60));
  client->cancel(job);
  EXPECT_EQ(client->wait_for_end(job).state(), v1::Job::CANCELLED);
}

TEST_F(Workers, HaveNoNetworkAndCannotHarmTheDaemon) {
  start(DaemonProcess::fake());
  const v1::Job job = run("socket\nkill-parent");
  ASSERT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
  const std::string report = client->download(job.name() + "/artifacts/report.json");
  EXPECT_NE(report.find("no-inet no-unix no-kill no-tgkill no-prlimit"), std::string::npos)
      << report;
}

TEST_F(Workers, CannotRaiseTheirPriority) {
  start(DaemonProcess::fake());
  const v1::Job job = run("hurry");
  ASSERT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
  const std::string report = client->download(job.name() + "/artifacts/report.json");
  EXPECT_NE(report.find("no-fifo no-nice no-rtprio"), std::string::npos) << report;
}

TEST_F(Workers, ReadTheirOwnInputsAndChangeNothingOutsideTheirFolder) {
  if (hydroprint::confine::landlock_version() == 0) GTEST_SKIP() << "this kernel has no Landlock";
  start(DaemonProcess::fake());
  const auto secret = folder.write("secret", "secret");
  const v1::Job job =
      run("read m.obj\nwrite m.obj\nread " + secret.string() + "\nwrite " + secret.string() +
          "\nread " + (daemon->state() / "hydroprint.db").string() + "\nread /etc/passwd");
  ASSERT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
  const std::string report = client->download(job.name() + "/artifacts/report.json");
  EXPECT_NE(report.find("READ cannot-write cannot-read cannot-write cannot-read READ"),
            std::string::npos)
      << report;
}

TEST_F(Workers, CannotStartProcesses) {
  start(DaemonProcess::fake());
  const v1::Job job = run("fork");
  ASSERT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
  const std::string report = client->download(job.name() + "/artifacts/report.json");
  EXPECT_NE(report.find("no-fork"), std::string::npos) << report;
}

TEST_F(Workers, MalformedProgressIsIgnored) {
  start(DaemonProcess::fake());
  const v1::Job job = run("babble");
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
  EXPECT_EQ(run("#").state(), v1::Job::SUCCEEDED);
}

TEST_F(Workers, RunInParallelUpToTheNumberOfSlots) {
  start(DaemonProcess::fake());
  for (int i = 0; i < 3; ++i) client->simulate("sleep 60\n#" + std::to_string(i));
  client->wait_for("jobs/1", v1::Job::RUNNING);
  client->wait_for("jobs/2", v1::Job::RUNNING);
  const v1::Queue queue = client->queue();
  EXPECT_EQ(queue.worker_slots(), 2);
  EXPECT_EQ(queue.running_jobs_size(), 2);
  EXPECT_EQ(queue.queued_count(), 1);
  client->cancel("jobs/1");
  client->wait_for("jobs/3", v1::Job::RUNNING);
}

/// A tetrahedron with 20 mm edges and colours at its vertices.
std::string coloured_tetrahedron_ply() {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
         "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
         "7 7 7 255 0 0\n7 -7 -7 0 255 0\n-7 7 -7 0 0 255\n-7 -7 7 99 99 99\n"
         "3 0 1 2\n3 0 2 3\n3 0 3 1\n3 1 3 2\n";
}

class RealWorker : public Workers {
 protected:
  void SetUp() override {
    if (!real_worker_is_built()) GTEST_SKIP() << kNeedsRealWorker;
    start({});
  }

  /// Waits until a job has ended, longer than usual, for slow machines and sanitizers.
  v1::Job patient_end(v1::Job job) const {
    for (int i = 0; i < 10 && !finished(job); ++i) {
      try {
        job = client->wait_for_end(job.name());
      } catch (const std::runtime_error&) {
        job = client->job(job.name());
      }
    }
    return job;
  }
};

TEST_F(RealWorker, ComputesAllArtifactsOfAModel) {
  auto request = simulate_request(client->upload(ball_obj()), "ball.obj");
  request.mutable_job()->mutable_simulate()->set_dpi(72);
  v1::Job job;
  ASSERT_TRUE(client->create(request, job).ok());
  job = patient_end(job);
  ASSERT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
  const std::string film = client->download(job.name() + "/artifacts/film.png");
  EXPECT_EQ(film.substr(0, 8), "\x89PNG\r\n\x1a\n");
  for (const char* name : {"surface_map.ply", "film_map.exr", "stretch.png", "error.png",
                           "predicted.png", "report.json"}) {
    EXPECT_FALSE(client->download(job.name() + "/artifacts/" + name).empty()) << name;
  }
  EXPECT_TRUE(client->simulate(ball_obj()).cache_hit() == false)
      << "another dpi is another input, so the cache must not be used";
  v1::Job again;
  ASSERT_TRUE(client->create(request, again).ok());
  EXPECT_TRUE(again.cache_hit());
}

class RealPlan : public RealWorker {
 protected:
  /// Computes a plan of two opposite dips.
  v1::Job make_plan() {
    v1::CreateJobRequest request;
    v1::PlanSpec& spec = *request.mutable_job()->mutable_plan();
    v1::InputFile& mesh = *spec.mutable_object()->mutable_mesh();
    mesh.set_name("ball.ply");
    mesh.set_asset(client->upload(coloured_tetrahedron_ply()));
    spec.mutable_film()->set_film("60x60");
    spec.mutable_film()->set_model(v1::MODEL_STOKES);
    spec.set_dpi(72);
    for (int k = 0; k < 2; ++k) {
      v1::Pose& pose = *spec.add_immersions()->mutable_pose();
      for (int i = 0; i < 4; ++i) pose.add_rotation_wxyz(i == k ? 1 : 0);
      for (int i = 0; i < 3; ++i) pose.add_translation_mm(0);
    }
    return done(request);
  }
  v1::Job done(const v1::CreateJobRequest& request) {
    v1::Job job;
    const grpc::Status created = client->create(request, job);
    EXPECT_TRUE(created.ok()) << created.error_message();
    job = patient_end(job);
    EXPECT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
    return job;
  }
  static v1::CreateJobRequest dip_of(const std::string& plan, int immersion) {
    v1::CreateJobRequest request;
    request.mutable_job()->mutable_simulate()->set_plan_job(plan);
    request.mutable_job()->mutable_simulate()->set_immersion(immersion);
    return request;
  }
  /// The message of the refusal of a dip; the reason is in front.
  std::string refusal(const v1::CreateJobRequest& request) {
    v1::Job job;
    const grpc::Status status = client->create(request, job);
    EXPECT_FALSE(status.ok());
    return error_info(status).reason() + ": " + status.error_message();
  }
  v1::Calibration enter_calibration(const std::array<double, 4>& rotation_wxyz, double scale) {
    v1::CreateCalibrationRequest request;
    v1::Calibration& calibration = *request.mutable_calibration();
    calibration.mutable_mesh()->set_name("ball.ply");
    calibration.mutable_mesh()->set_asset(client->upload(coloured_tetrahedron_ply()));
    calibration.set_scale(scale);
    calibration.set_film("60x60");
    calibration.mutable_pose()->mutable_rotation_wxyz()->Assign(rotation_wxyz.begin(),
                                                                rotation_wxyz.end());
    for (int i = 0; i < 3; ++i) calibration.mutable_pose()->add_translation_mm(0);
    v1::Calibration out;
    const auto stub = v1::CalibrationService::NewStub(client->channel);
    throw_unless_ok(stub->CreateCalibration(client->context().get(), request, &out),
                    "CreateCalibration");
    return out;
  }
  v1::PlanProgress progress(const std::string& plan) {
    v1::GetPlanProgressRequest request;
    request.set_name(plan);
    v1::PlanProgress out;
    throw_unless_ok(client->jobs->GetPlanProgress(client->context().get(), request, &out),
                    "GetPlanProgress");
    return out;
  }
};

TEST_F(RealPlan, ComputesAPlanAndEachOfItsDips) {
  const v1::Job plan = make_plan();
  for (const char* name :
       {"plan.json", "plan.ply", "report.json", "stretch-1.png", "complete-1.png", "mask-1.png",
        "film-1.png", "film-2.png", "combined.png"}) {
    EXPECT_FALSE(client->download(plan.name() + "/artifacts/" + name).empty()) << name;
  }
  EXPECT_EQ(progress(plan.name()).next_immersion(), 1);
  EXPECT_EQ(progress(plan.name()).dips(1).step(), v1::PlanProgress::SIMULATE) << "without a camera";

  const v1::Job dip = done(dip_of(plan.name(), 2));
  EXPECT_EQ(dip.simulate().film(), "60x60");
  EXPECT_EQ(dip.simulate().mesh().name(), "ball.ply");
  EXPECT_EQ(client->download(dip.name() + "/artifacts/film.png"),
            client->download(plan.name() + "/artifacts/film-2.png"))
      << "at the planned pose";
  EXPECT_EQ(progress(plan.name()).next_immersion(), 2);
  EXPECT_EQ(progress(plan.name()).dips(1).step(), v1::PlanProgress::LAY_OUT);

  // Its film image is printed as that of any other simulation, also after the plan was deleted.
  v1::CreateJobRequest print;
  print.mutable_job()->mutable_print_image()->set_simulate_job(dip.name());
  (void)done(print);
  const v1::PlanProgress before = progress(plan.name());
  EXPECT_EQ(before.dips(1).step(), v1::PlanProgress::DIP);
  daemon->kill();
  daemon->start();
  client = std::make_unique<Client>(daemon->address());
  EXPECT_EQ(progress(plan.name()).DebugString(), before.DebugString()) << "after a restart";
  v1::DeleteJobRequest remove;
  remove.set_name(plan.name());
  google::protobuf::Empty none;
  throw_unless_ok(client->jobs->DeleteJob(client->context().get(), remove, &none), "DeleteJob");
  v1::RetryJobRequest retry;
  retry.set_name(dip.name());
  v1::Job again;
  throw_unless_ok(client->jobs->RetryJob(client->context().get(), retry, &again), "RetryJob");
  EXPECT_EQ(patient_end(again).state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(refusal(dip_of(plan.name(), 1)).substr(0, 14), "JOB_NOT_FOUND:");
}

TEST_F(RealPlan, CalibratedDipIsComputedForTheMeasuredPose) {
  const v1::Job plan = make_plan();
  const double half = 8 * M_PI / 180 / 2;
  const v1::Calibration turned = enter_calibration({0, std::cos(half), std::sin(half), 0}, 1);
  EXPECT_EQ(progress(plan.name()).dips(0).calibration(), turned.name());
  v1::CreateJobRequest request = dip_of(plan.name(), 2);
  request.mutable_job()->mutable_simulate()->set_calibration("calibrations/active");
  const v1::Job dip = done(request);
  EXPECT_EQ(dip.simulate().calibration(), turned.name());
  EXPECT_EQ(dip.simulate().pose().rotation_wxyz(1), turned.pose().rotation_wxyz(1));
  const auto report =
      nlohmann::json::parse(client->download(dip.name() + "/artifacts/report.json"));
  EXPECT_NEAR(report["plan"]["turn_deg"].get<double>(), 8, 1e-6);
  const v1::PlanProgress now = progress(plan.name());
  EXPECT_EQ(now.next_immersion(), 2);
  ASSERT_GT(now.dips(1).warnings_size(), 0) << "before anything is printed";
  EXPECT_NE(now.dips(1).warnings(0).message().find("turned by 8.0 degrees"), std::string::npos);
  EXPECT_EQ(now.dips(0).calibration(), "") << "the object hangs as for dip 2";

  (void)enter_calibration({1, 0, 0, 0}, 2);
  const std::string found = refusal(request);
  EXPECT_NE(found.find("simulate.calibration: calibrations/2 is for scale 2, but jobs/1 for 1"),
            std::string::npos)
      << found;
}

TEST_F(RealPlan, DipsThatDoNotFitThePlanAreRefusedByName) {
  const v1::Job plan = make_plan();
  const auto has = [&](const v1::CreateJobRequest& request, const std::string& words) {
    const std::string found = refusal(request);
    EXPECT_NE(found.find(words), std::string::npos) << found;
  };
  has(dip_of(plan.name(), 3), "simulate.immersion: is 3, but jobs/1 has 2 dips");
  has(dip_of(plan.name(), 0), "simulate.immersion");
  v1::CreateJobRequest request = dip_of(plan.name(), 1);
  request.mutable_job()->mutable_simulate()->clear_immersion();
  has(request, "simulate.immersion: is missing");
  request = dip_of(plan.name(), 1);
  request.mutable_job()->mutable_simulate()->set_scale(2);
  has(request, "scale");
  request = dip_of(plan.name(), 1);
  request.mutable_job()->mutable_simulate()->mutable_mesh()->set_name("other.ply");
  request.mutable_job()->mutable_simulate()->mutable_mesh()->set_asset(client->upload(ball_obj()));
  has(request, "simulate.mesh: is not the mesh of jobs/1 (ball.ply)");
  request = dip_of(plan.name(), 1);
  request.mutable_job()->mutable_simulate()->set_calibration("calibrations/9");
  has(request, "CALIBRATION_MISSING: simulate.calibration");
  const v1::Job simulation = run("v 0 0 nan\nf 1 1 1\n");
  has(dip_of(simulation.name(), 1), "names a simulate job; name a plan job");
}

TEST_F(RealWorker, BadModelIsRefusedWithItsName) {
  const v1::Job job = run("v 0 0 nan\nf 1 1 1\n");
  ASSERT_EQ(job.state(), v1::Job::FAILED);
  EXPECT_EQ(job.error().reason(), v1::INPUT_REFUSED) << job.error().message();
  EXPECT_EQ(job.error().exit_status(), 3);
  EXPECT_NE(job.error().message().find("m.obj"), std::string::npos) << job.error().message();
}

}  // namespace
}  // namespace hydroprint::tests
