#pragma once

#include <string>

namespace hydroprint::confine {

/// Describes what the kernel has granted to the calling process, as one line of JSON. Limits are
/// soft limits; null: no limit.
///
///     {"seccomp":true,"landlock_version":7,
///      "limits":{"data_bytes":5905580032,"cpu_s":3610,"file_bytes":4294967296,"open_files":256}}
///
/// @param is_confined  whether confine() succeeded
[[nodiscard]] std::string granted_json(bool is_confined);

}  // namespace hydroprint::confine
