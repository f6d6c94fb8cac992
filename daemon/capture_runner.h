#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include "daemon/calibration_store.h"
#include "daemon/camera_setup.h"
#include "daemon/clock.h"
#include "daemon/job_store.h"
#include "daemon/layout.h"
#include "daemon/live_camera.h"
#include "daemon/rig_desk.h"
#include "daemon/rig_place.h"
#include "daemon/sandbox.h"

namespace hydroprint::daemon {

/// What captures work on.
struct CaptureSurroundings {
  CameraSetup camera;
  LiveCamera& live;
  JobStore& jobs;
  CalibrationStore& calibrations;
  RigDesk& desk;
  PlaceKeeper& places;
  Layout layout;
  Clock clock;
};

/// Takes frames of the camera, one capture at a time: a process of hydroprint-capture each, watched
/// by a thread of its own, so that a driver that hangs or crashes harms nothing. Any thread may
/// call.
class CaptureRunner {
 public:
  /// @param surroundings  outlive it
  [[nodiscard]] static Result<std::unique_ptr<CaptureRunner>> make(
      CaptureSurroundings surroundings);
  /// Stops if stop() was not called.
  ~CaptureRunner();
  CaptureRunner(const CaptureRunner&) = delete;
  CaptureRunner& operator=(const CaptureRunner&) = delete;

  /// kFailedPrecondition, CAMERA_MISSING if none is configured; kAborted, MOTION_IN_PROGRESS while
  /// the axis moves.
  [[nodiscard]] Status check() const;
  /// Stores a capture and begins it. Refuses what check() and JobStore::create() refuse.
  [[nodiscard]] Result<Job> create(const NewJob& made, const RequestKey& request, double seconds);
  [[nodiscard]] Result<Job> cancel(std::int64_t job);
  /// The one that is under way; 0: none.
  [[nodiscard]] std::int64_t job() const { return job_; }

  /// Ends a capture that is under way, whose job is left to JobStore::interrupt_all(); a few
  /// seconds at most.
  void stop();

 private:
  CaptureRunner(CaptureSurroundings surroundings, Sandbox sandbox)
      : around_(std::move(surroundings)), sandbox_(std::move(sandbox)) {}
  void go(const Job& job, double seconds);
  [[nodiscard]] Status run(const Job& job, double seconds);
  void give_up(const Job& job, const Error& error);

  CaptureSurroundings around_;
  Sandbox sandbox_;
  std::mutex mutex_;
  bool end_ = false;  // no more of them
  std::atomic<std::int64_t> job_{0};
  std::atomic<bool> cancelled_{false}, left_{false};
  std::thread thread_;
};

}  // namespace hydroprint::daemon
