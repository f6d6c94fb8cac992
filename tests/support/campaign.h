#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

namespace hydroprint::testing {

/// Returns the positive number in an environment variable, or `otherwise` if it is not set.
inline int number_in_environment(const char* variable, int otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::stoi(text);
}

/// Number of random inputs of a test: `sample` in `tests/run`, and a multiple of it in
/// `tests/campaign` (HYDROPRINT_ROUNDS_FACTOR).
inline int campaign_rounds(int sample) {
  return sample * number_in_environment("HYDROPRINT_ROUNDS_FACTOR", 1);
}

/// The seed of a test's random inputs: `fixed` in `tests/run`. `tests/campaign` adds its own seed
/// (HYDROPRINT_SEED), so that a failure can be repeated.
inline std::uint32_t campaign_seed(std::uint32_t fixed) {
  return fixed + static_cast<std::uint32_t>(number_in_environment("HYDROPRINT_SEED", 0));
}

}  // namespace hydroprint::testing
