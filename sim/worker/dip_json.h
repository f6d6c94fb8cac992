#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/worker/report.h"

// For inclusion in .cpp files only.
namespace hydroprint::worker {

[[nodiscard]] nlohmann::ordered_json film_json(const film::Outline& outline);
[[nodiscard]] nlohmann::ordered_json profile_json(const film::Profile& profile);

/// [{code, message, where}]
[[nodiscard]] nlohmann::ordered_json warnings_json(const Warnings& warnings);

/// {p50, p95, max}
[[nodiscard]] nlohmann::ordered_json stretch_json(const pipeline::DipFigures& figures);

/// What every verb is told that has a dip.
[[nodiscard]] nlohmann::ordered_json dip_parameters_json(const Report& report);

/// What simulate and predict were told and found out.
[[nodiscard]] nlohmann::ordered_json dip_json(const Report& report);

/// The figures that matter, and the same for people.
[[nodiscard]] nlohmann::ordered_json dip_summary_json(const pipeline::DipFigures& figures);
[[nodiscard]] std::string dip_text(const Report& report, const std::filesystem::path& dir);

}  // namespace hydroprint::worker
