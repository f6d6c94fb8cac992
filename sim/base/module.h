#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint {

/// What a module that lies beside the program exports by a name; the module is loaded if it is not
/// yet, and stays so. Refuses (kInternal) what cannot be loaded.
/// @param file  "hydroprint-....so"
[[nodiscard]] Result<void*> module_symbol(const std::string& file, const std::string& name);

}  // namespace hydroprint
