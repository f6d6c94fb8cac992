#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/http/protocol/request_parser.h"
#include "sim/base/result.h"

namespace hydroprint::http {

/// The upload that a path is about: "/v1/uploads/3" is "uploads/3". Refused as rest::decode does.
/// @param path  begins with "/v1/"
[[nodiscard]] Result<std::string> upload_name(std::string_view path);

/// Where the bytes of this request go in their upload: the header Upload-Offset, 0 or more.
/// Refused (kInvalidArgument, SPEC_INVALID, field Upload-Offset) if it is missing, there twice, or
/// no number.
[[nodiscard]] Result<std::int64_t> upload_offset(const HeaderFields& fields);

}  // namespace hydroprint::http
