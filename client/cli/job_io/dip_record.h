#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/cli/job_io/wait.h"
#include "client/job.h"

namespace hydroprint::cli {

/// Downloads what a dip left (positions.csv, report.json) into `folder`; nothing if it left
/// nothing.
[[nodiscard]] Result<std::vector<Downloaded>> fetch_record(client::Connection& daemon,
                                                           const std::string& job,
                                                           const std::filesystem::path& folder);

/// One line on a dip from its record: depth, speed, largest deviation from constant speed; what of
/// these report.json does not tell is left out.
[[nodiscard]] std::string dip_summary(const client::Job& job, const std::vector<Downloaded>& files);

}  // namespace hydroprint::cli
