#pragma once

#include "daemon/auth/accounts.h"
#include "daemon/config/config.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Whether clients of other machines may reach one of the doors.
[[nodiscard]] bool is_exposed(const Config& config);

/// Refuses (kInvalidArgument, CONFIG_INVALID), naming what is missing: an address beyond loopback
/// without TLS; a certificate without its key, or the other way round.
[[nodiscard]] Status check_exposure(const Config& config);

/// Refuses (kFailedPrecondition, SIGN_IN_NEEDED) an address beyond loopback while there is no admin
/// who can sign in. Whoever comes from elsewhere needs a user, and nobody could ever make one.
[[nodiscard]] Status check_admin(const Config& config, const auth::Accounts& accounts);

}  // namespace hydroprint::daemon
