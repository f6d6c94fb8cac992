#pragma once

#include <cstddef>

namespace hydroprint::mesh {

/// Number of shells that Surface::shells lists.
inline constexpr std::size_t kShellsListed = 10;

/// How the outer side of a shell was found.
enum class SideRule {
  kVolume,     ///< its volume is positive; open shells inside a closed one are closed by a cone
  kCavity,     ///< it bounds a cavity inside another shell, so it faces inward
  kRays,       ///< rays from one side reach the open more often
  kUndecided,  ///< open, and rays see the same from both sides: by volume, or as in the file
};

/// A shell of the model: triangles connected across edges of exactly two faces.
struct Shell {
  std::size_t triangles = 0;  ///< of the model
  double area_mm2 = 0;
  bool closed = false;
  SideRule rule = SideRule::kVolume;
  bool turned_over = false;  ///< it faced the other way in the file
};

}  // namespace hydroprint::mesh
