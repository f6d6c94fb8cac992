#pragma once

#include <filesystem>
#include <string>

#include "client/connection/connection.h"
#include "client/files/files.h"
#include "hydroprint/v1/artifact_service.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Returns the artifact's file name: "film.png" for "jobs/7/artifacts/film.png".
[[nodiscard]] std::string file_name(const v1::Artifact& artifact);

/// Returns all artifacts of a job, sorted by name; empty until the job has succeeded.
[[nodiscard]] Result<v1::ListArtifactsResponse> list_artifacts(Connection& connection,
                                                               const std::string& job);

/// Downloads an artifact into `folder` (created if missing) under its file name. The bytes go into
/// a hidden file in `folder`, from which a later attempt resumes. The final file appears only when
/// all bytes have arrived and their SHA-256 matches. An existing file with the same bytes is kept;
/// one with other bytes is replaced.
/// @return the file's path; kDataLoss if the bytes are not what the daemon announced
[[nodiscard]] Result<std::filesystem::path> download(Connection& connection,
                                                     const v1::Artifact& artifact,
                                                     const std::filesystem::path& folder,
                                                     const ByteProgress& progress = {});

}  // namespace hydroprint::client
