#pragma once

#include <string>

#include "sim/validate/validate.h"

namespace hydroprint::validate {

/// The report for people: one HTML page whose pictures lie beside it, without scripts, well-formed
/// as XML too.
/// @param version  of the program, for the page's foot
[[nodiscard]] std::string report_html(const Report& report, const std::string& version);

/// What a figure is held against, for people: "at most 0.15 mm"; empty if it is not.
[[nodiscard]] std::string limit_text(const Figure& figure);

}  // namespace hydroprint::validate
