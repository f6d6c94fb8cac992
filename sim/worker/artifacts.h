#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/pipeline/predict.h"
#include "sim/pipeline/simulate.h"

namespace hydroprint::worker {

/// Writes the artifacts of a run (contract) but for report.json into a folder.
/// @return the files' names. Fails as image::write_artifact does.
[[nodiscard]] Result<std::vector<std::string>> write_artifacts(
    const std::filesystem::path& folder, const pipeline::Simulation& simulation, double dpi,
    const Context& context);
[[nodiscard]] Result<std::vector<std::string>> write_artifacts(
    const std::filesystem::path& folder, const pipeline::Prediction& prediction,
    const Context& context);

}  // namespace hydroprint::worker
