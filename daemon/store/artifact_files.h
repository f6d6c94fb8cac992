#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/store/job.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// Returns the media type for a file name's extension; "application/octet-stream" if unknown.
[[nodiscard]] std::string media_type(const std::string& name);

/// Creates `folder` with a job's input files, under their names. Replaces an existing folder.
/// @return kFailedPrecondition, ASSET_MISSING if a file is missing
[[nodiscard]] Status lay_out_inputs(const Layout& layout, const std::vector<InputFile>& inputs,
                                    const std::filesystem::path& folder);

/// Publishes a worker's files in `from` as the artifacts of a job: only regular files, hashed,
/// synced to disk, then made visible with a single rename to `to`.
/// @return kInternal, WORKER_UNUSABLE if there is anything except regular files, or no file
[[nodiscard]] Result<std::vector<Artifact>> publish_artifacts(const std::filesystem::path& from,
                                                              const std::filesystem::path& to);

}  // namespace hydroprint::daemon
