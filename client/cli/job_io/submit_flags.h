#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/job_io/inputs.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::cli {

/// The flags of `submit KIND` and `preview`.
struct SubmitOptions {
  v1::Job job;  ///< flags that need no file are stored in its spec directly
  /// Fields whose flags name files, each with the text of its flag. The files are read and uploaded
  /// after the parsing.
  std::vector<std::pair<const google::protobuf::FieldDescriptor*, std::string>> files;
};

/// Adds a flag for each field of the spec of options.job, or only for the fields named in `only`.
/// The rules of the fields (proto/rules) state which flags are required or exclude each other.
void add_spec_flags(CLI::App& command, SubmitOptions& options,
                    const std::vector<std::string>& only = {});

/// Uploads the files given by the flags. @return the job with its whole spec
[[nodiscard]] Result<v1::Job> upload_inputs(Inputs& inputs, const SubmitOptions& options);

}  // namespace hydroprint::cli
