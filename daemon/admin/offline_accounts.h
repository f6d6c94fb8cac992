#pragma once

#include <string>

#include "daemon/admin/offline_state.h"

namespace hydroprint::admin {

/// Sets a user's password, ends all of their sessions and links, and waits until a daemon that runs
/// goes by it.
/// @return USER_NOT_FOUND, SPEC_INVALID; kUnavailable if the daemon does not take note
[[nodiscard]] Status reset_password(State& state, const std::string& user,
                                    const std::string& password);

/// The token of a link by which that user signs in once, within 15 minutes.
/// @return USER_NOT_FOUND; kFailedPrecondition for one who is barred
[[nodiscard]] Result<std::string> sign_in_link(State& state, const std::string& user);

}  // namespace hydroprint::admin
