#pragma once

#include <filesystem>
#include <string_view>

#include "sim/base/context.h"

namespace hydroprint::mesh {

/// Checks an STL file, binary (its length must be what its facet count says) or ASCII (read to its
/// last word). Refuses, with the line or facet: lying counts, truncated files, facets that do not
/// have three corners, numbers that are none or not finite.
/// @return number of facets
[[nodiscard]] Result<std::size_t> check_stl(std::string_view bytes,
                                            const std::filesystem::path& path,
                                            const Context& context);

}  // namespace hydroprint::mesh
