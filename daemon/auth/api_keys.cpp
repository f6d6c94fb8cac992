#include "daemon/auth/api_keys.h"

#include <algorithm>

#include "daemon/auth/secret.h"
#include "sim/base/sha256.h"

namespace hydroprint::auth {
namespace {

constexpr std::string_view kKeyPrefix = "hp_";
constexpr std::size_t kKeyIdBytes = 8;
constexpr std::size_t kKeySecretBytes = 32;
constexpr std::size_t kLongestKeyName = 100;

bool has_control_characters(const std::string& text) {
  return std::any_of(text.begin(), text.end(),
                     [](unsigned char c) { return c < ' ' || c == 0x7f; });
}

}  // namespace

std::optional<Caller> ApiKeys::caller(std::string_view key, bool is_use) {
  if (!key.starts_with(kKeyPrefix)) return std::nullopt;
  key.remove_prefix(kKeyPrefix.size());
  const std::size_t between = key.find('_');
  if (between == std::string_view::npos || key.size() > 1000) return std::nullopt;
  const std::string hash = sha256(key.substr(between + 1));
  const std::lock_guard lock(rows_.memory);
  const auto found = rows_.keys.find(std::string(key.substr(0, between)));
  if (found == rows_.keys.end() || !equal_in_constant_time(found->second.secret_hash, hash)) {
    return std::nullopt;
  }
  ApiKey& held = found->second;
  const std::int64_t now_ms = clock_();
  const User* const user = rows_.admitted(held.user);
  if (user == nullptr || (held.expire_ms != 0 && held.expire_ms <= now_ms)) return std::nullopt;
  if (is_use) held.use_ms = now_ms;
  return Caller{user->name, std::min(user->role, held.role), "key " + held.id, "", true};
}

Result<std::pair<ApiKey, std::string>> ApiKeys::create(const NewKey& fields) {
  if (fields.display_name.size() > kLongestKeyName || has_control_characters(fields.display_name)) {
    return fail(Code::kInvalidArgument,
                "display_name: must be at most 100 bytes without control characters",
                ErrorReason::SPEC_INVALID);
  }
  const std::lock_guard writing(rows_.writing);
  HP_RETURN_IF_ERROR(users_.get(fields.user));
  if (list(fields.user, "", most_).size() >= most_) {
    return fail(Code::kResourceExhausted,
                "users/" + fields.user + ": too many API keys; delete some first",
                ErrorReason::KEYS_FULL);
  }
  const std::int64_t now_ms = clock_();
  const std::string secret = random_hex(kKeySecretBytes);
  const ApiKey key{random_hex(kKeyIdBytes),
                   fields.user,
                   fields.display_name,
                   sha256(secret),
                   fields.role,
                   now_ms,
                   fields.ttl_ms == 0 ? 0 : now_ms + fields.ttl_ms,
                   0};
  HP_RETURN_IF_ERROR(rows_.database.run(
      "INSERT INTO api_keys(id, user, display_name, secret_hash, role, create_ms, expire_ms, "
      "use_ms) VALUES (?,?,?,?,?,?,?,0)",
      {key.id, key.user, key.display_name, key.secret_hash, static_cast<std::int64_t>(key.role),
       key.create_ms, key.expire_ms}));
  const std::lock_guard lock(rows_.memory);
  rows_.keys[key.id] = key;
  return std::pair{key, std::string(kKeyPrefix) + key.id + "_" + secret};
}

std::vector<ApiKey> ApiKeys::list(const std::string& user, const std::string& after,
                                  std::size_t limit) const {
  const std::lock_guard lock(rows_.memory);
  std::vector<ApiKey> out;
  for (auto next = rows_.keys.upper_bound(after); next != rows_.keys.end() && out.size() < limit;
       ++next) {
    if (user.empty() || next->second.user == user) out.push_back(next->second);
  }
  return out;
}

Result<ApiKey> ApiKeys::get(const std::string& id) const {
  const std::lock_guard lock(rows_.memory);
  const auto found = rows_.keys.find(id);
  if (found == rows_.keys.end()) {
    return fail(Code::kNotFound, "apiKeys/" + id + " does not exist", ErrorReason::KEY_NOT_FOUND);
  }
  return found->second;
}

Status ApiKeys::remove(const std::string& id) {
  const std::lock_guard writing(rows_.writing);
  HP_RETURN_IF_ERROR(rows_.database.run("DELETE FROM api_keys WHERE id=?", {id}));
  const std::lock_guard lock(rows_.memory);
  rows_.keys.erase(id);
  return {};
}

}  // namespace hydroprint::auth
