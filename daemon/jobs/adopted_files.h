#pragma once

#include <string>

#include "daemon/jobs/kind.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::daemon {

/// Stores an artifact of a finished job as an asset, and returns it as an input file for another
/// job. The other job can then be run again after the finished job is deleted. Returns the errors
/// of AssetStore::adopt().
/// @param job   id of the finished job
/// @param name  name of the input file
[[nodiscard]] Result<v1::InputFile> adopt_artifact(std::int64_t job, const Artifact& artifact,
                                                   const std::string& name,
                                                   const JobSources& sources);

/// Stores a text as an asset, and returns it as an input file. Used for text from a file that may
/// change later.
[[nodiscard]] Result<v1::InputFile> adopt_text(const std::string& text, const std::string& name,
                                               const JobSources& sources);

/// Adds the frames of a capture job to `frames`, as input files in one folder.
/// @param field  name of the spec's field that names the capture, for errors
/// @return errors as in earlier_job() and adopt_artifact()
[[nodiscard]] Status adopt_frames(const std::string& capture, const std::string& field,
                                  const std::string& folder, const JobSources& sources,
                                  google::protobuf::RepeatedPtrField<v1::InputFile>& frames);

}  // namespace hydroprint::daemon
