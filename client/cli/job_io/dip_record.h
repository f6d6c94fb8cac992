#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/cli/job_io/wait.h"
#include "client/job.h"

namespace hydroprint::cli {

/// Downloads the record of a dip (positions.csv, report.json) into `folder`; returns an empty list
/// if there is no record.
[[nodiscard]] Result<std::vector<Downloaded>> fetch_record(client::Connection& daemon,
                                                           const std::string& job,
                                                           const std::filesystem::path& folder);

/// Summarizes a dip's record in one line: depth, speed, largest deviation from constant speed.
/// Values missing from report.json are omitted.
[[nodiscard]] std::string dip_summary(const v1::Job& job, const std::vector<Downloaded>& files);

}  // namespace hydroprint::cli
