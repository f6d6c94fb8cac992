#pragma once

#include <filesystem>

#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}

namespace hydroprint::worker {

/// Reads a spec from a file of proto3 JSON, at most 16 MiB; "-" means stdin. Rejects text that is
/// not JSON, unknown fields, values of the wrong type, fields that only the daemon can resolve
/// (references to jobs and calibrations), and named files that are missing in `inputs`. Errors
/// about the text name the file; errors about a field are those of fail_field().
[[nodiscard]] Status read_spec(const std::filesystem::path& file,
                               const std::filesystem::path& inputs,
                               google::protobuf::Message& spec);

}  // namespace hydroprint::worker
