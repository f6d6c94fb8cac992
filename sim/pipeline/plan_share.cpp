#include "sim/pipeline/plan_share.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "sim/base/number_text.h"
#include "sim/plan/seam_shift.h"

namespace hydroprint::pipeline {
namespace {

constexpr double kSamePoint_mm = 1e-6;
constexpr double kMostTurn_rad = 5 * std::numbers::pi / 180;
constexpr double kMostShift_mm = 10;
constexpr double kMostLost = 0.01;
constexpr const char* kRemedy =
    "Hang the object as planned, or make a new plan with the pose as it is now";

bool is_planned(const mesh::Surface& surface, const PlanShare& share) {
  if (surface.points.size() != share.points.size() || surface.triangles != share.triangles)
    return false;
  for (std::size_t i = 0; i < share.points.size(); ++i) {
    if (!((surface.points[i] - share.points[i]).norm() <= kSamePoint_mm)) return false;
  }
  return true;
}

Eigen::Vector3d middle_mm(const std::vector<Eigen::Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  return box.center();
}

/// Returns the share of a dip's region whose triangles its film does not wholly reach.
double lost_share(const plan::Fragments& fragments, const mesh::Surface& surface, int dip,
                  const std::vector<double>& stretch) {
  double lost_mm2 = 0, all_mm2 = 0;
  for (std::size_t i = 0; i < fragments.all.size(); ++i) {
    const plan::Fragment& fragment = fragments.all[i];
    if (fragment.dip != dip) continue;
    const auto triangle = static_cast<std::size_t>(fragment.triangle);
    const Eigen::Vector3i& t = surface.triangles[triangle];
    const double area_mm2 = fragments.share(i) * plan::area_mm2(surface, triangle);
    all_mm2 += area_mm2;
    const bool is_reached = std::isfinite(stretch[static_cast<std::size_t>(t[0])]) &&
                            std::isfinite(stretch[static_cast<std::size_t>(t[1])]) &&
                            std::isfinite(stretch[static_cast<std::size_t>(t[2])]);
    if (!is_reached) lost_mm2 += area_mm2;
  }
  return all_mm2 > 0 ? lost_mm2 / all_mm2 : 0;
}

}  // namespace

Result<Division> divide_as_planned(const mesh::Surface& surface, const PlanShare& share,
                                   const Context& context) {
  if (!is_planned(surface, share)) {
    return fail(Code::kInvalidArgument,
                fmt::format("plan.ply: its surface ({} points, {} triangles) is not the one made "
                            "from this mesh ({} points, {} triangles). Make the plan again",
                            share.points.size(), share.triangles.size(), surface.points.size(),
                            surface.triangles.size()));
  }
  return divide(surface, dividing_stretch(share.X_FO, share.stretch), share.blend_mm, context);
}

Result<PlanDeviation> deviation_from(const PlanShare& share, const Division& division,
                                     const mesh::Surface& surface, const Pose& X_FO,
                                     const std::vector<double>& stretch, const Context& context) {
  const auto k = static_cast<std::size_t>(share.dip - 1);
  const Pose& planned = share.X_FO[k];
  PlanDeviation out;
  out.turn_rad = Eigen::AngleAxisd(X_FO.linear() * planned.linear().transpose()).angle();
  const Eigen::Vector3d middle = middle_mm(surface.points);
  out.shift_mm = (X_FO * middle - planned * middle).head<2>();
  out.lost_share = lost_share(division.regions.fragments, surface, share.dip, stretch);
  plan::Stretch now = share.stretch;
  now[k] = stretch;
  HP_ASSIGN_OR_RETURN(
      const plan::Regions regions,
      plan::make_regions(surface, dividing_stretch(share.X_FO, std::move(now)), {}, context));
  HP_ASSIGN_OR_RETURN(out.seam_shift_mm,
                      plan::seam_shift_mm(regions.seam, division.regions.seam, share.dip, context));
  return out;
}

Warnings warnings_of_deviation(const PlanDeviation& deviation, const PlanShare& share) {
  Warnings out;
  const std::string dip = fmt::format("dip {}", share.dip);
  const auto warn = [&](WarningCode code, std::string what) {
    out.push_back({code, std::move(what) + ". " + kRemedy, {{}, share.dip}});
  };
  if (deviation.turn_rad > kMostTurn_rad ||
      deviation.shift_mm.cwiseAbs().maxCoeff() > kMostShift_mm) {
    warn(WarningCode::PLAN_POSE_OFF,
         fmt::format("the object is turned by {:.1f} degrees and displaced by ({:.1f}, {:.1f}) mm "
                     "from the planned pose of {}",
                     deviation.turn_rad * 180 / std::numbers::pi, deviation.shift_mm.x(),
                     deviation.shift_mm.y(), dip));
  }
  if (deviation.lost_share > kMostLost) {
    warn(WarningCode::PLAN_REACH_LOST,
         fmt::format("at this pose, the film does not reach {} of the part that {} prints, which "
                     "stays bare",
                     percent(deviation.lost_share), dip));
  }
  if (deviation.seam_shift_mm > share.blend_mm) {
    const std::string far = std::isfinite(deviation.seam_shift_mm)
                                ? fmt::format("{} mm", three_digits(deviation.seam_shift_mm))
                                : "far";
    warn(
        WarningCode::PLAN_SEAM_MOVED,
        fmt::format("at this pose, the film is stretched least up to a seam that is up to {} from "
                    "the planned one (blend width: {} mm), so near the planned one it is stretched "
                    "more than needed",
                    far, three_digits(share.blend_mm)));
  }
  return out;
}

}  // namespace hydroprint::pipeline
