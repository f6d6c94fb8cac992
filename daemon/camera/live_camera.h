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

/// What the camera saw, as CameraService shows it.
struct LivePicture {
  std::string png;
  int width = 0, height = 0;
  double nearest_mm = 0, farthest_mm = 0;
  double measured_share = 0;
  std::string camera;        ///< maker and model
  std::int64_t time_ms = 0;  ///< when it came
};

/// Shows people what the camera sees: one process of hydroprint-capture while somebody looks, and
/// none a little later. A job that needs the camera borrows it. Any thread may call; a camera that
/// hangs holds up nobody but those who look.
class LiveCamera {
 public:
  /// @return kFailedPrecondition if the machine cannot confine processes
  [[nodiscard]] static Result<std::unique_ptr<LiveCamera>> make(CameraConfig camera, Layout layout,
                                                                Clock clock);
  /// Stops if stop() was not called.
  ~LiveCamera();
  LiveCamera(const LiveCamera&) = delete;
  LiveCamera& operator=(const LiveCamera&) = delete;

  /// A picture of the last 3 s; waits for one, 5 s at most.
  /// @param gone  whether the caller has left, asked now and then
  /// @return as CameraService.GetDepthPicture describes; kCancelled; kUnavailable, SHUTTING_DOWN
  [[nodiscard]] Result<LivePicture> look(const std::function<bool()>& gone);
  /// When the latest picture came, Unix time in ms; 0: none did.
  [[nodiscard]] std::int64_t latest_ms() const;

  struct GiveBack {
    void operator()(LiveCamera* camera) const { camera->take_back(); }
  };
  /// While it lives, the camera is another's.
  using Loan = std::unique_ptr<LiveCamera, GiveBack>;
  /// Gives the camera to a job, one at a time: from now on, nobody is shown anything.
  [[nodiscard]] Loan lend(std::int64_t job);
  /// Waits until a camera that was lent is free, but no longer than 5 s: who finds it hanging then
  /// says so.
  void wait_until_free();

  /// Ends the process; whoever waits is told.
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
  std::int64_t lent_to_ = 0;          // a job; 0: nobody
  Time wanted_until_, again_, came_;  // came_: the picture
  std::optional<LivePicture> picture_;
  std::optional<Error> failure_;  // of the latest try, while somebody looks
  int waiting_ = 0;
  bool stopping_ = false;
  std::thread thread_;  // starts the process, which dies with it
};

}  // namespace hydroprint::daemon
