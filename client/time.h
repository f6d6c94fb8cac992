#pragma once

#include <google/protobuf/timestamp.pb.h>

#include <chrono>
#include <optional>

namespace hydroprint::client {

/// A point in time on the daemon's clock.
using Time = std::chrono::system_clock::time_point;

/// Converts a timestamp to the clock's resolution; nullopt for the default value, which unset
/// fields have.
[[nodiscard]] std::optional<Time> time_of(const google::protobuf::Timestamp& timestamp);

}  // namespace hydroprint::client
