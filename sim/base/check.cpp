#include "sim/base/check.h"

#include <filesystem>
#include <string>

namespace hydroprint {

void throw_invariant_error(const char* file, int line, const char* condition) {
  throw InvariantError(std::filesystem::path(file).filename().string() + ":" +
                       std::to_string(line) + ": check failed: " + condition);
}

}  // namespace hydroprint
