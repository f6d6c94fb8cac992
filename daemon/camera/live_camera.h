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

/// A depth picture, as returned by CameraService.
struct LivePicture {
  std::string png;
  int width = 0, height = 0;
  double nearest_mm = 0, farthest_mm = 0;
  double measured_share = 0;
  std::string camera;        ///< maker and model
  std::int64_t time_ms = 0;  ///< time of arrival
};

/// Shows the camera's view. A process of hydroprint-capture runs while a client watches, and
/// shortly after. Jobs can borrow the camera. Thread-safe; a camera that hangs blocks only its
/// viewers.
class LiveCamera {
 public:
  /// @return kFailedPrecondition if this machine cannot confine processes
  [[nodiscard]] static Result<std::unique_ptr<LiveCamera>> make(CameraConfig camera, Layout layout,
                                                                Clock clock);
  /// Calls stop() if needed.
  ~LiveCamera();
  LiveCamera(const LiveCamera&) = delete;
  LiveCamera& operator=(const LiveCamera&) = delete;

  /// Returns a picture of the last 3 s; waits up to 5 s for one.
  /// @param gone  called repeatedly; returns whether the client has disconnected
  /// @return errors as described in CameraService.GetDepthPicture; kCancelled; kUnavailable,
  ///         SHUTTING_DOWN
  [[nodiscard]] Result<LivePicture> recent_picture(const std::function<bool()>& gone);
  /// Returns the Unix time in ms of the latest picture; 0 if there was none.
  [[nodiscard]] std::int64_t latest_ms() const;

  struct Releaser {
    void operator()(LiveCamera* camera) const { camera->release(); }
  };
  /// The job has exclusive use of the camera as long as this object lives.
  using Reservation = std::unique_ptr<LiveCamera, Releaser>;
  /// Lends the camera to a job, one at a time. No pictures are shown meanwhile.
  [[nodiscard]] Reservation reserve(std::int64_t job);
  /// Waits up to 5 s until the process that shows pictures has ended. If the camera hangs for
  /// longer, the job reports it.
  void wait_until_free();

  /// Ends the process; waiting calls return an error.
  void stop();

 private:
  using Time = CameraProcess::Time;

  LiveCamera(CameraConfig camera, Layout layout, Clock clock);
  [[nodiscard]] std::optional<Result<LivePicture>> available_answer(Time now) const;
  void release();
  void wake();
  void work();
  void step(Time now);
  void begin(Time now);
  void show(const FramedMessage& framed_message, Time now);
  void fail_for_now(Error error, Time now);
  void wait(std::unique_lock<std::mutex>& lock);

  const CameraConfig camera_;
  const Layout layout_;
  const Clock clock_;
  UniqueFd wake_;
  mutable std::mutex mutex_;
  std::condition_variable change_;
  std::unique_ptr<CameraProcess> process_;
  std::int64_t reserved_for_ = 0;                  // job id; 0: not lent
  Time wanted_until_, retry_time_, picture_time_;  // picture_time_: arrival of picture_
  std::optional<LivePicture> picture_;
  std::optional<Error> failure_;  // failure of the latest attempt, while a client watches
  int waiting_ = 0;
  bool stopping_ = false;
  std::thread thread_;  // starts the process, which is killed when the thread ends
};

}  // namespace hydroprint::daemon
