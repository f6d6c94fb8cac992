#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::openni_driver {

/// A connection to the control socket of hydroprint-virtual-rig. Every wait is bounded.
class RigLine {
 public:
  /// Refuses with kUnavailable where no rig listens.
  [[nodiscard]] static Result<RigLine> connect(const std::string& path);
  RigLine(RigLine&& other) noexcept;
  RigLine& operator=(RigLine&&) = delete;
  ~RigLine();

  /// Says a line and gives back the reply's. Refuses with kUnavailable when the rig has gone, with
  /// kAborted when it says nothing for a second (then its reply is still to come: the next
  /// call waits for it and says nothing), and with kFailedPrecondition what the rig itself refuses.
  [[nodiscard]] Result<std::string> ask(const std::string& line);
  /// The same, but waits half a minute: a scene may have millions of triangles to tell of.
  [[nodiscard]] Result<std::string> ask_patiently(const std::string& line);

 private:
  explicit RigLine(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
  bool owes_ = false;  // a reply that did not come in time
  std::string heard_;
};

}  // namespace hydroprint::openni_driver
