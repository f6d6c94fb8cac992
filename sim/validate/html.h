#pragma once

#include <string>

#include "sim/validate/validate.h"

namespace hydroprint::validate {

/// Formats the report as one HTML page; its pictures are in the same folder. The page has no
/// scripts and is also well-formed XML.
/// @param version  of the program, for the footer
[[nodiscard]] std::string report_html(const Report& report, const std::string& version);

/// Formats a figure's limit: "at most 0.15 mm"; empty if it has none.
[[nodiscard]] std::string limit_text(const Figure& figure);

}  // namespace hydroprint::validate
