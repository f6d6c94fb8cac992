#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/database.h"
#include "daemon/job.h"

namespace hydroprint::daemon {

/// How long a request id is remembered.
inline constexpr std::int64_t kRequestMemoryMs = 7LL * 24 * 3600 * 1000;

/// What an earlier request of the same id led to; none if there was none (or it had no id).
/// To be called within the transaction that carries out the request.
/// @return kInvalidArgument, REQUEST_ID_REUSED if that request was another one
[[nodiscard]] Result<std::optional<std::string>> earlier_result(Database& database,
                                                                const std::string& owner,
                                                                const RequestKey& key,
                                                                std::int64_t now_ms);

/// Remembers what the request led to, within the same transaction.
[[nodiscard]] Status remember_result(Database& database, const std::string& owner,
                                     const RequestKey& key, const std::string& result,
                                     std::int64_t now_ms);

/// Forgets what is too old.
[[nodiscard]] Status forget_old_requests(Database& database, std::int64_t now_ms);

}  // namespace hydroprint::daemon
