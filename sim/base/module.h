#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint {

/// Returns a symbol that a module beside the program exports. Loads the module if necessary; it
/// stays loaded. Error: kInternal if it cannot be loaded.
/// @param file  "hydroprint-....so"
[[nodiscard]] Result<void*> module_symbol(const std::string& file, const std::string& name);

}  // namespace hydroprint
