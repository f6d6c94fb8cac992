#pragma once

#include <filesystem>
#include <string_view>

#include "sim/base/context.h"

namespace hydroprint::mesh {

/// Checks an STL file, binary (its length must match its facet count) or ASCII (read to its last
/// word). Rejects wrong counts, truncated files, facets without three corners, and malformed or
/// non-finite numbers. Errors name the line or facet.
/// @return number of facets
[[nodiscard]] Result<std::size_t> check_stl(std::string_view bytes,
                                            const std::filesystem::path& path,
                                            const Context& context);

}  // namespace hydroprint::mesh
