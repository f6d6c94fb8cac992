#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim/print/placement.h"
#include "sim/print/print_image.h"
#include "sim/worker/options.h"

// For inclusion in .cpp files only.
namespace hydroprint::worker {

/// [x, y]
[[nodiscard]] nlohmann::ordered_json pair_of(const Eigen::Vector2d& v);

/// What print-image and template are told of the page.
[[nodiscard]] nlohmann::ordered_json page_parameters_json(const Options& options,
                                                          const nlohmann::ordered_json& film);

[[nodiscard]] nlohmann::ordered_json print_parameters_json(const Options& options,
                                                           const nlohmann::ordered_json& film);

/// What was printed where on which sheet.
[[nodiscard]] nlohmann::ordered_json print_json(const print::Print& print);

/// The same for people, in two lines.
[[nodiscard]] std::string print_text(const print::Print& print,
                                     const std::vector<std::string>& artifacts,
                                     const std::filesystem::path& dir);

/// Where the object meets the water, in F.
[[nodiscard]] nlohmann::ordered_json placement_json(const print::Placement& placement);
[[nodiscard]] std::string placement_text(const print::Placement& placement,
                                         const std::filesystem::path& dir);

}  // namespace hydroprint::worker
