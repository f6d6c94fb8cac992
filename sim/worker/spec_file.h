#pragma once

#include <filesystem>

#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}

namespace hydroprint::worker {

/// Reads a spec from proto3 JSON of at most 16 MiB; "-" is stdin. Rejects text that is not JSON,
/// unknown fields, values of the wrong type, fields that only the daemon can resolve (references to
/// jobs and calibrations), and named files that are missing in `inputs`. Errors name the file and
/// the field.
[[nodiscard]] Status read_spec(const std::filesystem::path& file,
                               const std::filesystem::path& inputs,
                               google::protobuf::Message& spec);

}  // namespace hydroprint::worker
