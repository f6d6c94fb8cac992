#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::mesh {

/// The whole of a regular file. Refuses with kNotFound what is missing, with kInvalidArgument what
/// is empty, not a regular file, or larger than 4 GiB.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path);

/// kInvalidArgument with one line "FILE: PLACE: WHAT".
[[nodiscard]] tl::unexpected<Error> bad_input(const std::filesystem::path& path,
                                              std::string_view place, std::string_view what);

/// Refuses no faces, and more than kMaxFaces (read_model.h), before memory is taken for them.
[[nodiscard]] Status check_face_count(std::size_t faces, const std::filesystem::path& path);

/// What to do about files that are damaged, in the words of every reader.
inline constexpr std::string_view kExportAgain = "; the file is damaged: export it again";

}  // namespace hydroprint::mesh
