#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/http/protocol/request_parser.h"
#include "sim/base/result.h"

namespace hydroprint::http {

/// Returns the upload named by a path: "uploads/3" for "/v1/uploads/3". Errors as in rest::decode.
/// @param path  begins with "/v1/"
[[nodiscard]] Result<std::string> upload_name(std::string_view path);

/// Returns the offset of the request's bytes in the upload, from the header Upload-Offset. Returns
/// kInvalidArgument, SPEC_INVALID (field Upload-Offset) if it is missing, occurs twice or is not a
/// number of at least 0.
[[nodiscard]] Result<std::int64_t> upload_offset(const HeaderFields& fields);

}  // namespace hydroprint::http
