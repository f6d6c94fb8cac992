#pragma once

#include <cstdint>

namespace hydroprint::daemon {

/// Where the rig stood at a moment, so that it can be told later whether it still does.
struct RigPlace {
  bool watched = false;  ///< there is a rig; the rest means nothing without
  bool homed = false;
  double axis_mm = 0;  ///< if it is homed
  /// How often it was homed, and dipped something, in the life of the store.
  std::int64_t homings = 0, dips = 0;

  bool operator==(const RigPlace&) const = default;
};

}  // namespace hydroprint::daemon
