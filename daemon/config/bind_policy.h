#pragma once

#include "daemon/auth/accounts.h"
#include "daemon/config/config.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Whether clients on other machines can reach one of the ports.
[[nodiscard]] bool is_exposed(const Config& config);

/// Refuses (kInvalidArgument, CONFIG_INVALID) an address beyond loopback without TLS, and a
/// certificate without its key or the reverse. The message names the missing key.
[[nodiscard]] Status check_exposure(const Config& config);

/// Refuses (kFailedPrecondition, SIGN_IN_NEEDED) an address beyond loopback while no admin can sign
/// in. Remote callers need a user, and nobody could create one.
[[nodiscard]] Status check_admin(const Config& config, auth::Accounts& accounts);

}  // namespace hydroprint::daemon
