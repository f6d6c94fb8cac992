#pragma once

#include <string_view>

namespace hydroprint {

/// All .proto files of the API and those they import, with their comments, which generated code
/// does not keep: a google.protobuf.FileDescriptorSet, serialised.
[[nodiscard]] std::string_view described_protos();

}  // namespace hydroprint
