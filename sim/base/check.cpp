#include "sim/base/check.h"

#include <fmt/format.h>

#include <filesystem>

namespace hydroprint {

void throw_invariant_error(const char* file, int line, const char* condition) {
  throw InvariantError(fmt::format(
      "{}:{}: check failed: {}", std::filesystem::path(file).filename().string(), line, condition));
}

}  // namespace hydroprint
