#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/fit/fit.h"

// For inclusion in .cpp files only.
namespace hydroprint::worker {

/// All that a fit found out but for the points one by one.
[[nodiscard]] nlohmann::ordered_json fit_json(const fit::Outcome& outcome,
                                              const fit::Options& options);

/// The figures that matter.
[[nodiscard]] nlohmann::ordered_json fit_summary_json(const fit::Outcome& outcome);

/// The same for people: a line for each parameter.
[[nodiscard]] std::string fit_text(const fit::Outcome& outcome, const std::filesystem::path& dir);

}  // namespace hydroprint::worker
