#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/store/database/database.h"
#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// How long request ids are stored.
inline constexpr std::int64_t kRequestMemoryMs = 7LL * 24 * 3600 * 1000;

/// Returns the result of an earlier request with the same id; nullopt if there was none, or if the
/// request has no id. Call this within the transaction that executes the request.
/// @return kInvalidArgument, REQUEST_ID_REUSED if the earlier request had different content
[[nodiscard]] Result<std::optional<std::string>> earlier_result(Database& database,
                                                                const std::string& owner,
                                                                const RequestKey& key,
                                                                std::int64_t now_ms);

/// Stores the result of a request. Call this within the transaction that executes the request.
[[nodiscard]] Status remember_result(Database& database, const std::string& owner,
                                     const RequestKey& key, const std::string& result,
                                     std::int64_t now_ms);

/// Records a request whose effect is not in the store, before it is executed. Returns true if it is
/// new or has no id; otherwise the caller must not execute it. If the request is then rejected,
/// call forget_request().
/// @return kInvalidArgument, REQUEST_ID_REUSED
[[nodiscard]] Result<bool> first_time(Database& database, const std::string& owner,
                                      const RequestKey& key, std::int64_t now_ms);
[[nodiscard]] Status forget_request(Database& database, const std::string& owner,
                                    const RequestKey& key);

/// Deletes request ids older than kRequestMemoryMs.
[[nodiscard]] Status forget_old_requests(Database& database, std::int64_t now_ms);

}  // namespace hydroprint::daemon
