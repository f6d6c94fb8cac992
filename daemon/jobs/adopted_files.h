#pragma once

#include <string>

#include "daemon/jobs/kind.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::daemon {

/// Turns an artifact of a finished job into an input file of another job, through an asset. The
/// other job can then be run again after the first is deleted. Returns the errors of
/// AssetStore::adopt().
/// @param job   the job that has the artifact
/// @param name  of the input file
[[nodiscard]] Result<v1::InputFile> adopt_artifact(std::int64_t job, const Artifact& artifact,
                                                   const std::string& name,
                                                   const JobSources& sources);

/// Turns a text into an input file, because its source file may change.
[[nodiscard]] Result<v1::InputFile> adopt_text(const std::string& text, const std::string& name,
                                               const JobSources& sources);

/// Adds the frames of a capture job as the files of one folder.
/// @param field  of the spec that names the capture, for errors
/// @return errors as in earlier_job() and adopt_artifact()
[[nodiscard]] Status adopt_frames(const std::string& capture, const std::string& field,
                                  const std::string& folder, const JobSources& sources,
                                  google::protobuf::RepeatedPtrField<v1::InputFile>& frames);

}  // namespace hydroprint::daemon
