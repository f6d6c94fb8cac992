#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "daemon/camera/camera_process.h"
#include "daemon/platform/clock.h"

namespace hydroprint::daemon {

/// A depth picture, as CameraService shows it.
struct LivePicture {
  std::string png;
  int width = 0, height = 0;
  double nearest_mm = 0, farthest_mm = 0;
  double measured_share = 0;
  std::string camera;        ///< maker and model
  std::int64_t time_ms = 0;  ///< time of arrival
};

/// Shows the camera's view. One process of hydroprint-capture runs while somebody watches, and
/// shortly after. Jobs can borrow the camera. Thread-safe; a hanging camera blocks only its
/// viewers.
class LiveCamera {
 public:
  /// @return kFailedPrecondition if the machine cannot confine processes
  [[nodiscard]] static Result<std::unique_ptr<LiveCamera>> make(CameraConfig camera, Layout layout,
                                                                Clock clock);
  /// Calls stop() if needed.
  ~LiveCamera();
  LiveCamera(const LiveCamera&) = delete;
  LiveCamera& operator=(const LiveCamera&) = delete;

  /// A picture of the last 3 s; waits for one for 5 s at most.
  /// @param gone  whether the caller has disconnected; polled
  /// @return errors as described in CameraService.GetDepthPicture; kCancelled; kUnavailable,
  /// SHUTTING_DOWN
  [[nodiscard]] Result<LivePicture> look(const std::function<bool()>& gone);
  /// Time of the latest picture, Unix time in ms; 0 if there was none.
  [[nodiscard]] std::int64_t latest_ms() const;

  struct GiveBack {
    void operator()(LiveCamera* camera) const { camera->take_back(); }
  };
  /// A job has the camera as long as this object lives.
  using Loan = std::unique_ptr<LiveCamera, GiveBack>;
  /// Gives the camera to a job, one at a time. No pictures are shown meanwhile.
  [[nodiscard]] Loan lend(std::int64_t job);
  /// Waits up to 5 s until a lent camera is free. A camera that still hangs is reported by the job.
  void wait_until_free();

  /// Ends the process; waiting calls return an error.
  void stop();

 private:
  using Time = CameraProcess::Time;

  LiveCamera(CameraConfig camera, Layout layout, Clock clock, Sandbox sandbox);
  [[nodiscard]] std::optional<Result<LivePicture>> known(Time now) const;
  void take_back();
  void wake();
  void work();
  void step(Time now);
  void begin(Time now);
  void show(const FramedMessage& told, Time now);
  void fail_for_now(Error error, Time now);
  void wait(std::unique_lock<std::mutex>& lock);

  const CameraConfig camera_;
  const Layout layout_;
  const Clock clock_;
  const Sandbox sandbox_;
  UniqueFd wake_;
  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::unique_ptr<CameraProcess> process_;
  std::int64_t lent_to_ = 0;          // job id; 0: nobody
  Time wanted_until_, again_, came_;  // came_: time of the picture
  std::optional<LivePicture> picture_;
  std::optional<Error> failure_;  // of the latest attempt, while somebody watches
  int waiting_ = 0;
  bool stopping_ = false;
  std::thread thread_;  // starts the process, which ends with it
};

}  // namespace hydroprint::daemon
