#pragma once

#include <filesystem>
#include <string>

#include "hydroprint/v1/report.pb.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

inline constexpr const char* kReport = "report.json";

/// Reads the report of a job strictly; see rest::read_json(). The file is untrusted.
/// @param artifacts  the folder of the job's artifacts
/// @param kind       name of the job kind: "print-image"
/// @return an empty message for a kind without a report; otherwise kDataLoss, ARTIFACT_DAMAGED if
///         the file is missing, larger than 4 MiB, or not such a report
[[nodiscard]] Result<v1::JobReport> read_report(const std::filesystem::path& artifacts,
                                                const std::string& kind);

}  // namespace hydroprint::daemon
