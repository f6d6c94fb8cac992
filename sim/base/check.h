#pragma once

#include <stdexcept>

namespace hydroprint {

/// Thrown when an invariant does not hold: a bug in this program, not bad input.
class InvariantError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws InvariantError; the message names the place and the condition. Called by HP_CHECK.
[[noreturn]] void throw_invariant_error(const char* file, int line, const char* condition);

}  // namespace hydroprint

/// Throws InvariantError unless the condition holds; checked in every build. A worker then ends
/// with an internal error, and a daemon request fails, instead of continuing with wrong numbers.
/// For bugs only; bad input yields an Error. Not for `hardware/rig` and `hardware/drive`, whose
/// threads keep the axis safe and must not throw (tests/architecture).
#define HP_CHECK(condition) \
  ((condition) ? void() : ::hydroprint::throw_invariant_error(__FILE__, __LINE__, #condition))
