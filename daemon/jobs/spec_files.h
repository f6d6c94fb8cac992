#pragma once

#include <string>
#include <vector>

#include "daemon/store/job.h"

namespace google::protobuf {
class Message;
}

namespace hydroprint::daemon {

/// Returns all input files of a spec, in the order of its fields.
/// @param path  of the spec, for errors: "print_image"
/// @return SPEC_INVALID, NAME_INVALID, ID_INVALID; NAME_INVALID if two files have the same name
[[nodiscard]] Result<std::vector<InputFile>> input_files(const google::protobuf::Message& spec,
                                                         const std::string& path);

/// Returns the name of the spec's main file; empty if it has no file.
[[nodiscard]] std::string first_file_name(const google::protobuf::Message& spec);

}  // namespace hydroprint::daemon
