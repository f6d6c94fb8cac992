#pragma once

#include <cstdint>

namespace hydroprint::daemon {

/// State of the rig at one time, to check later whether it has changed.
struct RigPlace {
  bool watched = false;  ///< whether a rig is configured; otherwise the other fields are not valid
  bool homed = false;
  double axis_mm = 0;  ///< axis position; valid only if homed
  /// Number of homings and dips since the store was created.
  std::int64_t homings = 0, dips = 0;

  bool operator==(const RigPlace&) const = default;
};

}  // namespace hydroprint::daemon
