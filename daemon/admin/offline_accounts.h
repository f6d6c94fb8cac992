#pragma once

#include <string>

#include "daemon/admin/offline_state.h"

namespace hydroprint::admin {

/// Sets a user's password, ends all of the user's sessions and sign-in links, and waits until a
/// running daemon has read the change.
/// @return USER_NOT_FOUND, SPEC_INVALID; kUnavailable if the daemon does not respond
[[nodiscard]] Status reset_password(State& state, const std::string& user,
                                    const std::string& password);

/// Creates a link with which the user can sign in once, within 15 minutes, and returns its token.
/// @return USER_NOT_FOUND; kFailedPrecondition for a disabled user
[[nodiscard]] Result<std::string> sign_in_link(State& state, const std::string& user);

}  // namespace hydroprint::admin
