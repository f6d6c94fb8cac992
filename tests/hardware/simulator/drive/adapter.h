#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "tests/hardware/simulator/drive/bench_rig.h"

namespace hydroprint::simulated_drive {

/// An adapter or gateway between a client and a virtual rig, which changes the bytes.
class Adapter {
 public:
  enum class Kind {
    kEcho,        ///< serial line: sends each request back
    kDeafEcho,    ///< the same, and the drive receives nothing
    kRtuOverTcp,  ///< TCP: passes RTU frames to the drive's serial line
    kUnit255,     ///< TCP: every reply comes from unit 255
  };

  /// @param bench  a rig on "rtu", or on "tcp" for kUnit255; must outlive this object
  Adapter(Kind kind, const BenchRig& bench);
  ~Adapter();
  Adapter(const Adapter&) = delete;
  Adapter& operator=(const Adapter&) = delete;

  /// The address for clients.
  [[nodiscard]] const drive::Endpoint& endpoint() const { return endpoint_; }

 private:
  void open_serial();
  void open_tcp();
  void open_drive(const drive::Endpoint& drive);
  void run();
  void accept_client();
  [[nodiscard]] bool forward_request();
  void forward_reply();

  Kind kind_;
  drive::Endpoint endpoint_;
  int listener_ = -1;
  int client_ = -1;
  int slave_ = -1;  // kept open, because otherwise reading from the terminal fails
  int drive_ = -1;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace hydroprint::simulated_drive
