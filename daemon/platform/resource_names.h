#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Returns the error kInvalidArgument, SPEC_INVALID, about a field.
[[nodiscard]] tl::unexpected<Error> invalid_field(std::string_view field, std::string_view problem);

/// Returns SPEC_INVALID for text longer than `max_bytes` or with control characters.
[[nodiscard]] Status check_text(std::string_view field, std::string_view text,
                                std::size_t max_bytes);

/// Returns kInvalidArgument, NAME_INVALID for anything except a plain file name or a relative path
/// of plain parts: see InputFile.name in proto/hydroprint/v1/spec.proto.
[[nodiscard]] Status check_file_name(std::string_view field, std::string_view name);

/// Returns true for 64 lower-case hex digits.
[[nodiscard]] bool is_sha256(std::string_view text);

/// Parsers of resource names. Errors: kInvalidArgument, ID_INVALID.
[[nodiscard]] Result<std::int64_t> parse_job_name(std::string_view name);  // "jobs/7"
[[nodiscard]] Result<std::int64_t> parse_calibration_name(
    std::string_view name);                                                  // "calibrations/7"
[[nodiscard]] Result<std::string> parse_asset_name(std::string_view name);   // "assets/{sha}"
[[nodiscard]] Result<std::string> parse_upload_name(std::string_view name);  // "uploads/{id}"
[[nodiscard]] Result<std::pair<std::int64_t, std::string>>
parse_artifact_name(  // "jobs/7/artifacts/x"
    std::string_view name);

/// Returns the resource name of a job: "jobs/7".
[[nodiscard]] std::string job_name(std::int64_t id);

/// Returns the resource name of a calibration: "calibrations/7".
[[nodiscard]] std::string calibration_name(std::int64_t id);

/// Parses a positive integer without sign, blanks or leading zeros; 0 for any other text.
[[nodiscard]] std::int64_t parse_number(std::string_view text);

/// Returns a random UUID (version 4).
[[nodiscard]] std::string make_uuid();

/// Returns 128 random bits as 32 hex digits.
[[nodiscard]] std::string make_token();

}  // namespace hydroprint::daemon
