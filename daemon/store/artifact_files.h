#pragma once

#include <chrono>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "daemon/store/job.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// Returns the media type for a file name's extension; "application/octet-stream" if unknown.
[[nodiscard]] std::string media_type(const std::string& name);

/// Creates `folder` with a job's input files, each under its InputFile::name. Replaces an existing
/// folder.
/// @return kFailedPrecondition, ASSET_MISSING if a file is missing; kCancelled after a request to
///         stop, as of copy_bytes()
[[nodiscard]] Status lay_out_inputs(const Layout& layout, const std::vector<InputFile>& inputs,
                                    const std::filesystem::path& folder,
                                    const std::stop_token& stop = {});

/// Limits of the files that become the artifacts of a job.
struct OutputLimits {
  std::int64_t file_bytes = 4LL << 30;    ///< of one file; sparse files count with their full size
  std::int64_t total_bytes = 16LL << 30;  ///< of all files together
};

/// Returns how long publishing may take: 60 s, and 1 s for each 20 MiB of the total.
[[nodiscard]] std::chrono::seconds publishing_time(const OutputLimits& limits);

/// How to publish files. The defaults are for files that the daemon itself wrote.
struct PublishOptions {
  /// Folder above the files, below which no link is followed; empty: the parent of their folder.
  std::filesystem::path within = {};
  /// New folder for a copy of the files, next to the artifacts; empty: their folder is moved. Once
  /// it is copied, nothing that still has the output open can change an artifact.
  std::filesystem::path copy = {};
  OutputLimits limits = {};
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
  std::stop_token stop = {};
};

/// Publishes the untrusted files in `from` as the artifacts of a job: checks them, hashes them,
/// copies them if requested, syncs them to disk, and makes them visible with a single rename of the
/// folder to `to`. Reads each file once, and only after number, names, types and sizes of all are
/// checked.
/// @return kInternal, WORKER_UNUSABLE if the folder is a link or has no files, too many, or
///         anything except regular files with valid names and without links; kResourceExhausted
///         with OUTPUT_LIMIT, TIME_LIMIT or DISK_FULL; kCancelled after a request to stop
[[nodiscard]] Result<std::vector<Artifact>> publish_artifacts(const std::filesystem::path& from,
                                                              const std::filesystem::path& to,
                                                              const PublishOptions& options = {});

}  // namespace hydroprint::daemon
