#pragma once

#include <string>

#include "sim/validate/validate.h"

namespace hydroprint::validate {

/// The report for people: one HTML page with its pictures in the same folder. It has no scripts and
/// is also well-formed XML.
/// @param version  of the program, for the footer
[[nodiscard]] std::string report_html(const Report& report, const std::string& version);

/// A figure's limit for people: "at most 0.15 mm"; empty if it has none.
[[nodiscard]] std::string limit_text(const Figure& figure);

}  // namespace hydroprint::validate
