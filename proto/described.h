#pragma once

#include <string_view>

namespace hydroprint {

/// A serialised google.protobuf.FileDescriptorSet of all .proto files of the API and their imports.
/// It includes the comments, which generated code does not keep.
[[nodiscard]] std::string_view described_protos();

}  // namespace hydroprint
