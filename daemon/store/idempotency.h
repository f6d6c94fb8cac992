#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/store/database/database.h"
#include "daemon/store/job.h"

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

/// Remembers a request whose effect is not in the store, before it is carried out: true if it is a
/// new one (or has no id); else nothing is to be done. One that is refused is to be forgotten.
/// @return kInvalidArgument, REQUEST_ID_REUSED
[[nodiscard]] Result<bool> first_time(Database& database, const std::string& owner,
                                      const RequestKey& key, std::int64_t now_ms);
[[nodiscard]] Status forget_request(Database& database, const std::string& owner,
                                    const RequestKey& key);

/// Forgets what is too old.
[[nodiscard]] Status forget_old_requests(Database& database, std::int64_t now_ms);

}  // namespace hydroprint::daemon
