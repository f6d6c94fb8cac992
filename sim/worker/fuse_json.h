#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/calibrate/swept_scan.h"

namespace hydroprint::worker {

/// Frames, how well they agree, the mesh's size, and what became of the markers.
[[nodiscard]] nlohmann::ordered_json swept_json(const calibrate::SweptScan& swept);

/// The summary for people.
[[nodiscard]] std::string swept_text(const calibrate::SweptScan& swept,
                                     const std::filesystem::path& dir);

}  // namespace hydroprint::worker
