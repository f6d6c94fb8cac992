#pragma once

#include <string>
#include <vector>

#include "daemon/store/job.h"

namespace google::protobuf {
class Message;
}

namespace hydroprint::daemon {

/// Returns all input files of a spec and the messages in it, in the order of their fields.
/// @param path  name of the spec's field in Job, for errors: "print_image"
/// @return NAME_INVALID for an invalid file name, or one that two files have; ID_INVALID for an
/// invalid asset name
[[nodiscard]] Result<std::vector<InputFile>> input_files(const google::protobuf::Message& spec,
                                                         const std::string& path);

/// Returns the name of the spec's main file: the first in a single field, otherwise the first in a
/// repeated field. Empty if there are no files.
[[nodiscard]] std::string first_file_name(const google::protobuf::Message& spec);

}  // namespace hydroprint::daemon
