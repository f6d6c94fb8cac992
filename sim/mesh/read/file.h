#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::mesh {

/// Returns the whole content of a regular file. Errors: kNotFound if it is missing;
/// kInvalidArgument if it is empty, not a regular file, or larger than 4 GiB; kPermissionDenied if
/// it cannot be read.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path);

/// Returns the text without the byte order mark with which Windows programs begin UTF-8.
[[nodiscard]] std::string without_byte_order_mark(std::string text);

/// Returns kInvalidArgument with the message "FILE: PLACE: WHAT" on one line.
[[nodiscard]] tl::unexpected<Error> bad_input(const std::filesystem::path& path,
                                              std::string_view place, std::string_view what);

/// Same as bad_input(), with the remedy to export the file again.
[[nodiscard]] tl::unexpected<Error> damaged(const std::filesystem::path& path,
                                            std::string_view place, std::string_view what);

/// Rejects a model with zero faces or more than kMaxFaces (read_model.h), before memory is
/// allocated for them.
[[nodiscard]] Status check_face_count(std::size_t faces, const std::filesystem::path& path);

}  // namespace hydroprint::mesh
