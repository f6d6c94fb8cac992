#pragma once

#include <stdexcept>

namespace hydroprint {

/// A broken invariant: a mistake in this program, not in its input.
class InvariantError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws InvariantError; the message names the place and the condition. Called by HP_CHECK.
[[noreturn]] void throw_invariant_error(const char* file, int line, const char* condition);

}  // namespace hydroprint

/// Throws InvariantError unless the condition holds; checked in every build. Then a worker ends
/// with an internal error, or a request to the daemon fails, instead of going on with wrong
/// numbers. For bugs in the program only; bad input yields an Error. Not for `hardware/rig` and
/// `hardware/drive`, whose threads keep the axis safe and must not throw (tests/architecture).
#define HP_CHECK(condition) \
  ((condition) ? void() : ::hydroprint::throw_invariant_error(__FILE__, __LINE__, #condition))
