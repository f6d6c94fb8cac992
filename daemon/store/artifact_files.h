#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/store/job.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// Media type by a file name's extension; "application/octet-stream" where it says nothing.
[[nodiscard]] std::string media_type(const std::string& name);

/// Puts a job's input files, under their names, into `folder` (made anew).
/// @return kFailedPrecondition, ASSET_MISSING if one is gone
[[nodiscard]] Status lay_out_inputs(const Layout& layout, const std::vector<InputFile>& inputs,
                                    const std::filesystem::path& folder);

/// Makes what a worker left in `from` the artifacts of a job: plain files only, hashed, safe on
/// disk, then visible at once by one rename to `to`.
/// @return kInternal, WORKER_UNUSABLE if there is anything but plain files, or nothing at all
[[nodiscard]] Result<std::vector<Artifact>> publish_artifacts(const std::filesystem::path& from,
                                                              const std::filesystem::path& to);

}  // namespace hydroprint::daemon
