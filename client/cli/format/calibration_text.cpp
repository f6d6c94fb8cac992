#include "client/cli/format/calibration_text.h"

#include <fmt/format.h>

#include "client/cli/terminal/console.h"
#include "client/name_of.h"
#include "proto/warning_message.h"

namespace hydroprint::cli {
namespace {

std::string markers_text(const v1::Calibration& c) {
  int used = 0;
  std::string left_out;
  for (const v1::Calibration::Marker& marker : c.markers()) {
    used += marker.used() ? 1 : 0;
    if (!marker.used())
      left_out += fmt::format("  marker {} left out: {}\n", printable(marker.name()),
                              printable(marker.why_not()));
  }
  if (c.markers().empty()) return "";
  return fmt::format("  {} of {} markers\n{}", used, c.markers_size(), left_out);
}

std::string object_text(const v1::Calibration& c) {
  std::string out;
  if (c.has_error_max_mm())
    out += fmt::format(
        "  surface position error: {:.2f} mm for 95 % of the surface, at most {:.2f} mm\n",
        c.error_p95_mm(), c.error_max_mm());
  out += markers_text(c);
  for (const std::string& what : c.symmetries())
    out +=
        fmt::format("  not measured, because it does not move the surface: {}\n", printable(what));
  for (const v1::Warning& warning : c.warnings())
    out += fmt::format("  warning: {}\n", hydroprint::text_of(warning));
  if (c.has_contact_mm()) out += fmt::format("  first contact at {:.2f} mm\n", c.contact_mm());
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
  std::string out = fmt::format("{}{}: {}\n", c.name(), c.active() ? " (active)" : "",
                                printable(c.display_name()));
  if (c.kind() == v1::Calibration::OBJECT)
    out += object_text(c);
  else
    out += fmt::format("  a camera, from {} views; residual of the board {:.2f} mm rms\n",
                       c.views(), c.rms_mm());
  for (const std::string& why : staleness_of(c)) out += fmt::format("  no longer valid: {}\n", why);
  return out;
}

}  // namespace hydroprint::cli
