// Live pictures of the virtual rig's camera, through the real programs.
#include <signal.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "hydroprint/v1/camera_service.grpc.pb.h"
#include "tests/daemon/api/calibrate_support.h"

namespace hydroprint::tests {
namespace {

class CameraApi : public CameraTest {
 protected:
  CameraApi() { start_rig(); }

  void serve(int patience_s = 20) { start_daemon(DaemonProcess::fake(), patience_s); }

  struct Look {
    grpc::Status status;
    v1::DepthPicture picture;
    [[nodiscard]] std::string reason() const { return error_info(status).reason(); }
  };
  Look look() {
    Look out;
    out.status = v1::CameraService::NewStub(ann->channel)
                     ->GetDepthPicture(ann->context().get(), {}, &out.picture);
    return out;
  }
  /// Requests pictures until one fails with this reason, or succeeds if the reason is "".
  [[nodiscard]] bool comes_to(const std::string& reason) {
    return wait_until(
        [&] {
          const Look seen = look();
          return seen.status.ok() ? reason.empty() : seen.reason() == reason;
        },
        60);
  }
};

TEST_F(CameraApi, PictureShowsThePresentView) {
  serve();
  ASSERT_TRUE(comes_to(""));
  const v1::DepthPicture first = look().picture;
  EXPECT_EQ(first.png().substr(1, 3), "PNG");
  EXPECT_EQ(first.width(), 320);
  EXPECT_EQ(first.height(), 240);
  EXPECT_GT(first.nearest_mm(), 100);
  EXPECT_GT(first.farthest_mm(), first.nearest_mm() + 100);
  EXPECT_LT(first.farthest_mm(), 5000);
  EXPECT_GT(first.measured_share(), 0.5);
  EXPECT_LE(first.measured_share(), 1);
  EXPECT_EQ(first.camera(), "Hydroprint virtual rig");
  EXPECT_GE(first.age_s(), 0);
  EXPECT_LT(first.age_s(), 3.5);
  EXPECT_TRUE(wait_until([&] {
    const v1::DepthPicture later = look().picture;
    return later.time().seconds() > first.time().seconds() && later.png() != first.png();
  })) << "new pictures arrive";
}

TEST_F(CameraApi, OneProcessServesAllViewersAndEndsWithoutThem) {
  if (!proc_is_mounted()) GTEST_SKIP() << kNeedsProc;
  serve();
  EXPECT_TRUE(daemon->workers().empty());
  std::atomic<int> fine{0};
  std::vector<std::thread> many;
  for (int i = 0; i < 8; ++i) many.emplace_back([&] { fine += comes_to("") ? 1 : 0; });
  for (std::thread& one : many) one.join();
  EXPECT_EQ(fine, 8);
  EXPECT_EQ(daemon->workers().size(), 1U);
  EXPECT_TRUE(wait_until([&] { return daemon->workers().empty(); }, 60));
  EXPECT_TRUE(comes_to("")) << "the camera starts again on request";
}

TEST_F(CameraApi, CaptureBorrowsTheCamera) {
  serve();
  ASSERT_TRUE(comes_to(""));
  const v1::Job job = create(capture_of(15));
  const Look meanwhile = look();
  EXPECT_EQ(meanwhile.status.error_code(), grpc::StatusCode::ABORTED);
  EXPECT_EQ(meanwhile.reason(), "CAMERA_BUSY");
  EXPECT_EQ(error_info(meanwhile.status).metadata().at("job"), job.name());
  ann->wait(job.name(), [](const v1::Job& now) { return now.progress_fraction() > 0; });
  if (proc_is_mounted()) {
    EXPECT_EQ(daemon->workers().size(), 1U) << "only the process of the capture runs";
  }
  ann->cancel(job.name());
  done(job);
  EXPECT_TRUE(comes_to("")) << "pictures are shown again";
  EXPECT_EQ(captured().state(), v1::Job::SUCCEEDED) << "the camera is free for captures";
}

TEST_F(CameraApi, CameraFaultIsReportedUntilItIsCleared) {
  serve();
  for (const auto& [fault, reason] : {std::pair("camera gone", "CAMERA_NOT_FOUND"),
                                      {"camera frozen", "CAMERA_FROZEN"},
                                      {"camera black", "CAMERA_BLACK"}}) {
    rig->act(fault);
    EXPECT_TRUE(comes_to(reason)) << fault;
    const Look seen = look();
    EXPECT_EQ(seen.status.error_code(), grpc::StatusCode::UNAVAILABLE) << fault;
    EXPECT_EQ(seen.status.error_message().find("hydroprint-capture"), std::string::npos);
    rig->act("clear");
    EXPECT_TRUE(comes_to("")) << "after " << fault;
  }
}

TEST_F(CameraApi, HangingCameraBlocksOnlyItsViewers) {
  serve(1);
  rig->act("camera hung");
  std::thread watcher([&] { EXPECT_TRUE(comes_to("CAMERA_STALLED")); });
  ann->make_ready();
  EXPECT_TRUE(ann->move_to(kAxis_mm, 5).ok());
  EXPECT_TRUE(ann->stop().ok());
  watcher.join();
  const v1::Job job = done(create(capture_of(0.2)));
  EXPECT_EQ(job.error().reason(), v1::CAMERA_STALLED) << "the capture reports its own error";
  rig->act("clear");
  EXPECT_TRUE(comes_to(""));
}

TEST_F(CameraApi, DeadProcessIsReplacedAndHungProcessIsKilled) {
  if (!proc_is_mounted()) GTEST_SKIP() << kNeedsProc;
  serve(1);
  ASSERT_TRUE(comes_to(""));
  for (const int signal : {SIGKILL, SIGSTOP}) {
    const auto processes = daemon->workers();
    ASSERT_EQ(processes.size(), 1U);
    const pid_t first = processes.front();
    ::kill(first, signal);
    EXPECT_TRUE(wait_until(
        [&] {
          (void)look();
          const auto now = daemon->workers();
          return now.size() == 1 && now.front() != first;
        },
        60));
    EXPECT_TRUE(comes_to(""));
  }
  const auto last = daemon->workers();
  daemon->kill();
  for (const pid_t pid : last) EXPECT_TRUE(wait_until([&] { return ::kill(pid, 0) != 0; }));
}

TEST_F(CameraApi, WithoutACameraThereIsNoPicture) {
  daemon = std::make_unique<DaemonProcess>(folder.path(), DaemonProcess::fake());
  connect();
  EXPECT_EQ(look().reason(), "CAMERA_MISSING");
}

}  // namespace
}  // namespace hydroprint::tests
