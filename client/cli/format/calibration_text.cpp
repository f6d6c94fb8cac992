#include "client/cli/format/calibration_text.h"

#include "client/cli/terminal/console.h"

namespace hydroprint::cli {
namespace {

std::string markers_text(const std::vector<client::CalibrationMarker>& markers) {
  std::size_t used = 0;
  std::string out, left_out;
  for (const client::CalibrationMarker& marker : markers) {
    used += marker.used ? 1 : 0;
    if (!marker.used)
      left_out +=
          "  marker " + printable(marker.name) + " left out: " + printable(marker.why_not) + "\n";
  }
  if (markers.empty()) return "";
  return "  " + std::to_string(used) + " of " + std::to_string(markers.size()) + " markers\n" +
         left_out;
}

std::string object_text(const client::Calibration& c) {
  std::string out;
  if (c.error_p95_mm)
    out += "  surface position error: " + format_fixed(*c.error_p95_mm) +
           " mm for 95 % of the surface, at most " + format_fixed(*c.error_max_mm) + " mm\n";
  out += markers_text(c.markers);
  for (const std::string& what : c.from_nominal_pose)
    out += "  from the nominal pose: " + printable(what) + "\n";
  if (c.contact_mm) out += "  first contact at " + format_fixed(*c.contact_mm) + " mm\n";
  if (c.job.empty()) out += "  entered by hand\n";
  return out;
}

}  // namespace

std::string text_of(const client::Calibration& c) {
  std::string out =
      c.name + (c.active ? " (active)" : "") + ": " + printable(c.display_name) + "\n";
  if (c.kind == "OBJECT")
    out += object_text(c);
  else
    out += "  a camera, from " + std::to_string(c.views) + " views; residual of the board " +
           format_fixed(c.rms_mm) + " mm rms\n";
  for (const std::string& why : c.stale) out += "  no longer valid: " + why + "\n";
  return out;
}

}  // namespace hydroprint::cli
