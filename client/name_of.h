#pragma once

#include <google/protobuf/generated_enum_reflection.h>

#include <string>

namespace hydroprint::client {

/// Returns the name of an enum value in the API, for example "QUEUED"; "UNKNOWN" if it is unset or
/// unknown to this client.
template <class Enum>
[[nodiscard]] std::string name_of(Enum value) {
  const auto* found = google::protobuf::GetEnumDescriptor<Enum>()->FindValueByNumber(value);
  return found == nullptr || found->number() == 0 ? "UNKNOWN" : found->name();
}

}  // namespace hydroprint::client
