#include "daemon/store/idempotency.h"

namespace hydroprint::daemon {

Result<std::optional<std::string>> earlier_result(Database& database, const std::string& owner,
                                                  const RequestKey& key, std::int64_t now_ms) {
  std::optional<std::string> result;
  if (key.id.empty()) return result;
  std::string digest;
  HP_RETURN_IF_ERROR(database.each(
      "SELECT digest, result FROM requests WHERE owner=? AND method=? AND id=? AND time_ms>?",
      {owner, key.method, key.id, now_ms - kRequestMemoryMs}, [&](const DbRow& row) {
        digest = row.text(0);
        result = row.text(1);
      }));
  if (result && digest != key.digest) {
    return fail(Code::kInvalidArgument,
                "request_id: already used for another request; use a new one for each request",
                ErrorReason::REQUEST_ID_REUSED);
  }
  return result;
}

Status remember_result(Database& database, const std::string& owner, const RequestKey& key,
                       const std::string& result, std::int64_t now_ms) {
  if (key.id.empty()) return {};
  return database.run("INSERT OR REPLACE INTO requests VALUES (?,?,?,?,?,?)",
                      {owner, key.method, key.id, key.digest, result, now_ms});
}

Result<bool> first_time(Database& database, const std::string& owner, const RequestKey& key,
                        std::int64_t now_ms) {
  bool is_new = true;
  if (key.id.empty()) return is_new;
  const Status done = database.transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const auto earlier, earlier_result(database, owner, key, now_ms));
    is_new = !earlier;
    return is_new ? remember_result(database, owner, key, "", now_ms) : Status();
  });
  HP_RETURN_IF_ERROR(done);
  return is_new;
}

Status forget_request(Database& database, const std::string& owner, const RequestKey& key) {
  if (key.id.empty()) return {};
  return database.run("DELETE FROM requests WHERE owner=? AND method=? AND id=?",
                      {owner, key.method, key.id});
}

Status forget_old_requests(Database& database, std::int64_t now_ms) {
  return database.run("DELETE FROM requests WHERE time_ms<=?", {now_ms - kRequestMemoryMs});
}

}  // namespace hydroprint::daemon
