#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "daemon/store/job.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// Returns the media type for a file name's extension; "application/octet-stream" if unknown.
[[nodiscard]] std::string media_type(const std::string& name);

/// Copies a worker's output from another file system to the new folder `to`, file by file: nothing
/// that still has the output open can change the copy.
/// @return kInternal, WORKER_UNUSABLE as publish_artifacts(); kResourceExhausted, DISK_FULL
[[nodiscard]] Status copy_output(const std::filesystem::path& from,
                                 const std::filesystem::path& to);

/// Creates `folder` with a job's input files, each under its InputFile::name. Replaces an existing
/// folder.
/// @return kFailedPrecondition, ASSET_MISSING if a file is missing; kCancelled after a request to
///         stop, as of copy_bytes()
[[nodiscard]] Status lay_out_inputs(const Layout& layout, const std::vector<InputFile>& inputs,
                                    const std::filesystem::path& folder,
                                    const std::stop_token& stop = {});

/// Publishes the files that a worker left in `from` as the artifacts of a job: hashes them, syncs
/// them to disk, and makes them visible with a single rename of the folder to `to`.
/// @return kInternal, WORKER_UNUSABLE if the folder has no files, too many, or anything except
/// regular files with valid names
[[nodiscard]] Result<std::vector<Artifact>> publish_artifacts(const std::filesystem::path& from,
                                                              const std::filesystem::path& to);

}  // namespace hydroprint::daemon
