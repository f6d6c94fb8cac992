#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "sim/pipeline/pipeline.h"
#include "sim/validate/measure.h"

namespace hydroprint::validate {

/// How much of a body's face one dip can print.
struct Verdict {
  double reached = 0;  ///< fraction of the face that film reaches
  double torn = 0;     ///< fraction of the face where the film is stretched until it tears

  [[nodiscard]] double good() const { return reached - torn; }
  [[nodiscard]] const char* text() const {
    return good() >= 0.95 ? "can be printed" : good() >= 0.5 ? "partly" : "cannot be printed";
  }
};

inline constexpr const char* kPrintableRule =
    "a face can be printed if film reaches 95 % of it without tearing (at a stretch of three, the "
    "default of a film profile). It can be printed partly if film reaches half of it in this way, "
    "and otherwise it cannot be printed.";

[[nodiscard]] inline Verdict judge(const pipeline::Dip& dip, const Region& face) {
  const flow::SurfaceMap& map = dip.map.surface;
  const double tear = film::Profile().tear_stretch;
  return {share_where(dip.surface, face, [&](std::size_t v) { return map.film_mm[v].allFinite(); }),
          share_where(dip.surface, face, [&](std::size_t v) { return map.stretch[v] > tear; })};
}

[[nodiscard]] inline std::string percent(double share) { return text_of(100 * share, 1) + " %"; }

/// Returns true on the outer wall of the sample mug, without its handle, foot and rim.
[[nodiscard]] inline bool is_mug_wall(const Eigen::Vector3d& p) {
  return std::abs(std::hypot(p.x(), p.y()) - 40) < 0.05 && p.z() > 6 && p.z() < 88;
}

/// Returns true on the inside of the sample bowl: its wall and its floor.
[[nodiscard]] inline bool is_bowl_inside(const Eigen::Vector3d& p) {
  return p.z() > 5 - 1e-6 && p.z() < 64 + 1e-6 && std::hypot(p.x(), p.y()) < 46 + 1e-6;
}

/// Returns true on the level part of the bowl's floor.
[[nodiscard]] inline bool is_bowl_floor(const Eigen::Vector3d& p) {
  return std::abs(p.z() - 5) < 1e-6 && std::hypot(p.x(), p.y()) < 35;
}

}  // namespace hydroprint::validate
