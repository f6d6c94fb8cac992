#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::openni_driver {

/// A connection to the control socket of hydroprint-virtual-rig. Every wait is bounded.
class RigLine {
 public:
  /// Returns kUnavailable if no rig listens.
  [[nodiscard]] static Result<RigLine> connect(const std::string& path);
  RigLine(RigLine&& other) noexcept;
  RigLine& operator=(RigLine&&) = delete;
  ~RigLine();

  /// Sends a line and returns the line of the response. Returns kUnavailable if the rig is gone and
  /// kFailedPrecondition if the rig reports an error. Returns kAborted if the rig does not respond
  /// within a second; the next call then only waits for that response and sends nothing.
  [[nodiscard]] Result<std::string> ask(const std::string& line);
  /// Same as ask(), with a timeout of half a minute: a scene may have millions of triangles.
  [[nodiscard]] Result<std::string> ask_until_deadline(const std::string& line);

 private:
  explicit RigLine(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
  bool is_reply_pending_ = false;  // a response is outstanding because it did not arrive in time
  std::string buffer_;
};

}  // namespace hydroprint::openni_driver
