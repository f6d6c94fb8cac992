#pragma once

#include <string_view>

namespace hydroprint {

/// Returns a serialised google.protobuf.FileDescriptorSet of all .proto files of the API and their
/// imports, including the comments, which generated code does not contain.
[[nodiscard]] std::string_view described_protos();

}  // namespace hydroprint
