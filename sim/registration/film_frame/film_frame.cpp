#include "sim/registration/film_frame/film_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/registration/film_frame/agreement.h"
#include "sim/registration/film_frame/matching.h"
#include "sim/registration/plane.h"
#include "sim/registration/visibility.h"

namespace hydroprint::registration {
namespace {

constexpr std::size_t kFewestMarkers = 3;
constexpr std::size_t kSightSamples = 600;
constexpr double kSight_mm = 8;
constexpr double kHiddenShare = 0.5;
constexpr double kMoved_mm = 40;  ///< a marker found within this distance of a place belongs there
constexpr double kWeak_mm = 5;

/// Returns the used pyramids, at their places in the layout, as one body in the film frame.
Shape body_of(const MarkerLayout& layout, const Matching& matching) {
  mesh::Surface all;
  for (std::size_t a = 0; a < layout.markers.size(); ++a) {
    if (matching.found[a] < 0) continue;
    all = joined(std::move(all),
                 moved(pyramid(layout.width_mm, layout.height_mm), layout.markers[a].X_FM));
  }
  return Shape(all);
}

std::vector<scan::ScanPoint> points_of(const std::vector<FoundMarker>& found,
                                       const Matching& matching) {
  std::vector<scan::ScanPoint> out;
  for (const int i : matching.found) {
    if (i < 0) continue;
    const auto& points = found[static_cast<std::size_t>(i)].points;
    out.insert(out.end(), points.begin(), points.end());
  }
  return out;
}

double rms_of(const Shape& shape, const Pose& X_BC, const std::vector<scan::ScanPoint>& points) {
  double squares = 0;
  for (const auto& p : points) {
    const Eigen::Vector3d at = X_BC * p.point_mm;
    squares += (shape.closest(at).point_mm - at).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(points.size()));
}

/// Returns why the marker at this place is not used.
std::string reason(const Marker& marker, const MarkerLayout& layout,
                   const std::vector<FoundMarker>& found, const Matching& matching,
                   const scan::DepthFrame& depth, const scan::Lens& lens, const Pose& X_CF) {
  const Pose X_CM = X_CF * marker.X_FM;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (std::find(matching.found.begin(), matching.found.end(), static_cast<int>(i)) !=
        matching.found.end())
      continue;
    const double off = (found[i].place_C() - X_CM.translation()).norm();
    if (off < kMoved_mm)
      return fmt::format("it is {:.1f} mm from its configured position. Move it back to its mark",
                         off);
  }
  const Shape shape(pyramid(layout.width_mm, layout.height_mm));
  const Sight sight = look_at(visible(shape, X_CM, kSightSamples), depth, lens, kSight_mm);
  if (sight.out_of_view > kHiddenShare)
    return "it is out of the camera's view. Aim the camera at all markers";
  if (sight.before + sight.without_depth + sight.out_of_view > kHiddenShare)
    return "it is hidden. Clear the camera's view of it";
  return "the scan does not show its shape. Check whether it is knocked over, dirty or missing";
}

scan::DepthFrame depths_of(const scan::Cloud& cloud) {
  scan::DepthFrame out{cloud.camera.lens.width_px, cloud.camera.lens.height_px,
                       std::vector<float>(cloud.at_pixel.size())};
  for (const auto& p : cloud.points)
    out.depth_mm[out.index(p.u, p.v)] = static_cast<float>(p.reported_mm);
  return out;
}

std::vector<MarkerReport> report(const std::vector<FoundMarker>& found, const Matching& matching,
                                 const MarkerLayout& layout, const Pose& X_CF,
                                 const scan::Cloud& cloud) {
  const Shape shape(pyramid(layout.width_mm, layout.height_mm));
  const scan::DepthFrame depth = depths_of(cloud);
  std::vector<MarkerReport> out;
  for (std::size_t a = 0; a < layout.markers.size(); ++a) {
    const Marker& marker = layout.markers[a];
    MarkerReport one{marker.name, matching.found[a] >= 0, 0, 0, {}};
    if (one.used) {
      const FoundMarker& own = found[static_cast<std::size_t>(matching.found[a])];
      const Pose X_CM = X_CF * marker.X_FM;
      one.rms_mm = rms_of(shape, X_CM.inverse(), own.points);
      one.residual_mm = (own.place_C() - X_CM.translation()).norm();
    } else {
      one.why_not = reason(marker, layout, found, matching, depth, cloud.camera.lens, X_CF);
    }
    out.push_back(std::move(one));
  }
  return out;
}

tl::unexpected<Error> too_few(const std::string& what) {
  return fail(Code::kFailedPrecondition, what, ErrorReason::TOO_FEW_MARKERS);
}

/// Describes the missing markers, as far as the nominal pose of the camera allows.
tl::unexpected<Error> no_match(const std::vector<FoundMarker>& found, const MarkerLayout& layout,
                               const Pose& nominal_CF) {
  if (found.size() >= kFewestMarkers)
    return too_few(
        fmt::format("{} markers are seen, but the distances between them differ from the "
                    "configuration. Move them back to their marks",
                    found.size()));
  std::vector<bool> is_seen(layout.markers.size());
  for (const FoundMarker& f : found) {
    const auto distance = [&](const Marker& marker) {
      return (nominal_CF * marker.X_FM.translation() - f.place_C()).norm();
    };
    const auto nearest = std::min_element(
        layout.markers.begin(), layout.markers.end(),
        [&](const Marker& a, const Marker& b) { return distance(a) < distance(b); });
    is_seen[static_cast<std::size_t>(nearest - layout.markers.begin())] = true;
  }
  std::string text =
      fmt::format("at least three markers are needed, but the camera sees only {}", found.size());
  for (std::size_t a = 0; a < is_seen.size(); ++a)
    if (!is_seen[a])
      text += "; \"" + layout.markers[a].name + "\" may be hidden, knocked over, dirty or missing";
  return too_few(text);
}

}  // namespace

Result<FilmFrame> find_film_frame(const scan::Cloud& cloud, const MarkerLayout& layout,
                                  const Pose& nominal_CF, const Context& context) {
  if (layout.markers.size() < kFewestMarkers)
    return fail(Code::kInvalidArgument,
                "the rig's configuration names fewer than three markers. Add markers to it");
  HP_ASSIGN_OR_RETURN(const Plane level, find_plane(cloud, nominal_CF.linear().col(2)));
  HP_ASSIGN_OR_RETURN(const auto found, find_markers(cloud, level, layout, context));
  Matching matching = match(found, layout, nominal_CF);
  if (matching.count() < static_cast<int>(kFewestMarkers))
    return no_match(found, layout, nominal_CF);
  matching = agreeing(std::move(matching), found, layout);
  if (!matching.agrees)
    return too_few(
        "the distances between the three usable markers differ from the configuration. Move them "
        "back to their marks, or calibrate the camera");
  FitOptions options;
  options.weak_sigma_mm = kWeak_mm;
  options.reach_mm = kSight_mm;
  FilmFrame out;
  HP_ASSIGN_OR_RETURN(out.fit,
                      fit_pose(body_of(layout, matching), points_of(found, matching), cloud.camera,
                               matching.X_CF, matching.X_CF, options, context));
  out.markers = report(found, matching, layout, out.X_CF(), cloud);
  for (const MarkerReport& m : out.markers)
    if (!m.used)
      out.warnings.push_back({WarningCode::MARKER_LEFT_OUT,
                              "marker \"" + m.name + "\": " + m.why_not,
                              {AtMarker{m.name}}});
  return out;
}

}  // namespace hydroprint::registration
