#pragma once

#include <string>
#include <vector>

#include "daemon/store/job.h"

namespace google::protobuf {
class Message;
}

namespace hydroprint::daemon {

/// All input files of a spec, in the order of its fields.
/// @param path  where the spec is, for errors: "print_image"
/// @return SPEC_INVALID, NAME_INVALID, ID_INVALID; NAME_INVALID if one name stands for two files
[[nodiscard]] Result<std::vector<InputFile>> input_files(const google::protobuf::Message& spec,
                                                         const std::string& path);

/// Name of the file that a spec is mostly about; empty if it has no file.
[[nodiscard]] std::string first_file_name(const google::protobuf::Message& spec);

}  // namespace hydroprint::daemon
