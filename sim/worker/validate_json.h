#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/validate/validate.h"
#include "sim/worker/options.h"

// For inclusion in .cpp files only.
namespace hydroprint::worker {

/// What `validate` was told.
[[nodiscard]] nlohmann::ordered_json validation_parameters_json(const Options& options);

/// All that the experiments found.
[[nodiscard]] nlohmann::ordered_json experiments_json(const validate::Report& report);

/// The outcome for people: a line, and one for each figure beyond its limit.
[[nodiscard]] std::string validation_text(const validate::Report& report,
                                          const std::filesystem::path& dir);

}  // namespace hydroprint::worker
