#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Builds the error kInvalidArgument, SPEC_INVALID: "field: what is wrong", with metadata `field`.
[[nodiscard]] tl::unexpected<Error> invalid_field(std::string_view field, std::string_view problem);

/// Refuses (SPEC_INVALID) text longer than `max_bytes` or with control characters.
[[nodiscard]] Status check_text(std::string_view field, std::string_view text,
                                std::size_t max_bytes);

/// Refuses (kInvalidArgument, NAME_INVALID) anything except a plain file name or a relative path of
/// plain parts: see InputFile.name in proto/hydroprint/v1/spec.proto.
[[nodiscard]] Status check_file_name(std::string_view field, std::string_view name);

/// True for 64 lower-case hex digits.
[[nodiscard]] bool is_sha256(std::string_view text);

/// Parsers of resource names; anything else is kInvalidArgument, ID_INVALID.
[[nodiscard]] Result<std::int64_t> parse_job_name(std::string_view name);  // "jobs/7"
[[nodiscard]] Result<std::int64_t> parse_calibration_name(
    std::string_view name);                                                  // "calibrations/7"
[[nodiscard]] Result<std::string> parse_asset_name(std::string_view name);   // "assets/{sha}"
[[nodiscard]] Result<std::string> parse_upload_name(std::string_view name);  // "uploads/{id}"
[[nodiscard]] Result<std::pair<std::int64_t, std::string>>
parse_artifact_name(  // "jobs/7/artifacts/x"
    std::string_view name);

/// Resource name of a job: "jobs/7".
[[nodiscard]] std::string job_name(std::int64_t id);

/// Resource name of a calibration: "calibrations/7".
[[nodiscard]] std::string calibration_name(std::int64_t id);

/// A positive whole number without sign, blanks or leading zeros; 0 if the text is anything else.
[[nodiscard]] std::int64_t parse_number(std::string_view text);

/// Random UUID (version 4).
[[nodiscard]] std::string make_uuid();

/// 128 random bits as 32 hex digits.
[[nodiscard]] std::string make_token();

}  // namespace hydroprint::daemon
