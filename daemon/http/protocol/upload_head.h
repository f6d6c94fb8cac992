#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/http/protocol/request_parser.h"
#include "sim/base/result.h"

namespace hydroprint::http {

/// The upload that a path names: "/v1/uploads/3" gives "uploads/3". Errors as in rest::decode.
/// @param path  begins with "/v1/"
[[nodiscard]] Result<std::string> upload_name(std::string_view path);

/// Offset of the request's bytes in the upload: the header Upload-Offset, 0 or more. Refused
/// (kInvalidArgument, SPEC_INVALID, field Upload-Offset) if it is missing, occurs twice or is not a
/// number.
[[nodiscard]] Result<std::int64_t> upload_offset(const HeaderFields& fields);

}  // namespace hydroprint::http
