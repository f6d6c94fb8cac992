#pragma once

#include <string_view>

namespace hydroprint {

/// The API's .proto files and their imports as a serialised google.protobuf.FileDescriptorSet. It
/// includes their comments, which generated code does not contain.
[[nodiscard]] std::string_view described_protos();

}  // namespace hydroprint
