#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::mesh {

/// Returns a key that is equal for names that differ only in upper and lower case or in Unicode
/// form (NFC, NFD). Names that are not UTF-8 are taken as Latin-1, as old exporters write them.
[[nodiscard]] std::string name_key(std::string_view name);

/// Finds the path of a texture named by a model in `folder`. Candidates are the name itself, the
/// name with slashes for backslashes, and its bare file name in the model's folder. Returns the
/// first that exists, else the name itself.
[[nodiscard]] std::filesystem::path resolve_texture(const std::filesystem::path& folder,
                                                    std::string name);

/// Finds a file whose name differs from that of a missing one only as name_key() allows: in the
/// missing file's own folder, else in the model's folder.
/// @return nullopt if no file or several files have such a name
[[nodiscard]] std::optional<std::filesystem::path> similar_file(
    const std::filesystem::path& missing, const std::filesystem::path& folder);

/// Returns the warning `SIMILAR_NAME`: `found` was taken for `missing`, which does not exist.
[[nodiscard]] Warning similar_name(const std::filesystem::path& missing,
                                   const std::filesystem::path& found,
                                   const std::filesystem::path& model);

}  // namespace hydroprint::mesh
