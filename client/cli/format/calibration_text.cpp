#include "client/cli/format/calibration_text.h"

#include "client/cli/terminal/console.h"
#include "client/name_of.h"

namespace hydroprint::cli {
namespace {

std::string markers_text(const v1::Calibration& c) {
  int used = 0;
  std::string left_out;
  for (const v1::Calibration::Marker& marker : c.markers()) {
    used += marker.used() ? 1 : 0;
    if (!marker.used())
      left_out += "  marker " + printable(marker.name()) +
                  " left out: " + printable(marker.why_not()) + "\n";
  }
  if (c.markers().empty()) return "";
  return "  " + std::to_string(used) + " of " + std::to_string(c.markers_size()) + " markers\n" +
         left_out;
}

std::string object_text(const v1::Calibration& c) {
  std::string out;
  if (c.has_error_p95_mm())
    out += "  surface position error: " + format_fixed(c.error_p95_mm()) +
           " mm for 95 % of the surface, at most " + format_fixed(c.error_max_mm()) + " mm\n";
  out += markers_text(c);
  for (const std::string& what : c.from_nominal_pose())
    out += "  from the nominal pose: " + printable(what) + "\n";
  if (c.has_contact_mm()) out += "  first contact at " + format_fixed(c.contact_mm()) + " mm\n";
  if (c.job().empty()) out += "  entered by hand\n";
  return out;
}

}  // namespace

std::vector<std::string> staleness_of(const v1::Calibration& calibration) {
  std::vector<std::string> names;
  for (const int why : calibration.stale())
    names.push_back(client::name_of(static_cast<v1::Calibration::Staleness>(why)));
  return names;
}

std::string text_of(const v1::Calibration& c) {
  std::string out =
      c.name() + (c.active() ? " (active)" : "") + ": " + printable(c.display_name()) + "\n";
  if (c.kind() == v1::Calibration::OBJECT)
    out += object_text(c);
  else
    out += "  a camera, from " + std::to_string(c.views()) + " views; residual of the board " +
           format_fixed(c.rms_mm()) + " mm rms\n";
  for (const std::string& why : staleness_of(c)) out += "  no longer valid: " + why + "\n";
  return out;
}

}  // namespace hydroprint::cli
