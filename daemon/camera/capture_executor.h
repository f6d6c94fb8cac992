#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include "daemon/camera/live_camera.h"
#include "daemon/config/camera_config.h"
#include "daemon/jobs/executor.h"
#include "daemon/platform/clock.h"
#include "daemon/rig/rig_gateway.h"
#include "daemon/rig/rig_reference.h"
#include "daemon/store/calibration_store.h"
#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"
#include "daemon/workers/local_executor.h"

namespace hydroprint::daemon {

/// The objects that captures use.
struct CaptureDependencies {
  CameraConfig camera;
  LiveCamera& live;
  JobStore& jobs;
  CalibrationStore& calibrations;
  RigGateway& gateway;
  RigReference& places;
  Layout layout;
  Clock clock;
};

/// Captures depth frames, one capture at a time. Each capture is a process of hydroprint-capture
/// with its own monitoring thread, so a driver that hangs or crashes does no harm. Thread-safe.
class CaptureExecutor final : public JobExecutor {
 public:
  /// @param dependencies  must outlive this object
  [[nodiscard]] static Result<std::unique_ptr<CaptureExecutor>> make(
      CaptureDependencies dependencies);
  /// Calls stop() if needed.
  ~CaptureExecutor() override;

  /// Errors: kFailedPrecondition, CAMERA_MISSING if no camera is configured; kAborted,
  /// MOTION_IN_PROGRESS while the axis moves.
  [[nodiscard]] Result<Job> check(const JobRequest& request) override;
  [[nodiscard]] Result<Job> create(const JobRequest& request) override;
  [[nodiscard]] Result<Job> cancel(std::int64_t job) override;
  /// Ends a running capture within a few seconds; JobStore::interrupt_all() then ends its job.
  void stop() override;

  /// Returns the end of the latest successful capture since the daemon started; Unix time in ms, 0
  /// if there is none.
  [[nodiscard]] std::int64_t latest_ms() const { return latest_ms_; }

 private:
  [[nodiscard]] Status check_camera_and_rig() const;
  explicit CaptureExecutor(CaptureDependencies dependencies)
      : dependencies_(std::move(dependencies)) {}
  void go(const Job& job, double seconds);
  [[nodiscard]] Status run(const Job& job, double seconds);
  void give_up(const Job& job, const Error& error);

  CaptureDependencies dependencies_;
  LocalExecutor processes_{1};  // used only by the thread of the capture
  std::mutex mutex_;
  bool end_ = false;  // no further captures
  std::atomic<std::int64_t> job_{0}, latest_ms_{0};
  std::atomic<bool> cancelled_{false}, left_{false};
  std::thread thread_;
};

}  // namespace hydroprint::daemon
