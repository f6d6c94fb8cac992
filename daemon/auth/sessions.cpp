#include "daemon/auth/sessions.h"

#include <fmt/format.h>

#include <algorithm>

#include "daemon/auth/secret.h"
#include "sim/base/sha256.h"

namespace hydroprint::auth {
namespace {

constexpr std::size_t kTokenBytes = 32;
constexpr std::size_t kSessionIdBytes = 8;
constexpr std::size_t kLongestToken = 1000;

tl::unexpected<Error> sign_in_failed(const char* what) {
  return fail(Code::kUnauthenticated, what, ErrorReason::SIGN_IN_FAILED);
}

tl::unexpected<Error> too_many_attempts(std::int64_t wait_ms) {
  const std::int64_t seconds = (wait_ms + 999) / 1000;
  auto refused =
      fail(Code::kResourceExhausted,
           fmt::format("too many attempts to sign in failed; try again in {} s", seconds),
           ErrorReason::TOO_MANY_ATTEMPTS);
  refused.value().metadata["retry_s"] = fmt::to_string(seconds);
  return refused;
}

}  // namespace

std::int64_t Sessions::expire_ms(const Session& session) const {
  return std::min(session.use_ms + options_.idle_ms, most_ms(session));
}

bool Sessions::is_valid(const Session& session) const { return clock_() < expire_ms(session); }

std::optional<Caller> Sessions::caller(std::string_view token, bool is_use) {
  if (token.size() > kLongestToken) return std::nullopt;
  const std::string hash = sha256(token);
  const std::lock_guard lock(rows_.memory);
  const auto found = rows_.sessions.find(hash);
  if (found == rows_.sessions.end() || !is_valid(found->second)) return std::nullopt;
  const User* const user = rows_.admitted(found->second.user);
  if (user == nullptr) return std::nullopt;
  if (is_use) found->second.use_ms = clock_();
  return Caller{user->name, user->role, "session", found->second.id, true};
}

Status Sessions::check_password(const std::string& name, const std::string& password,
                                const std::string& peer) {
  const std::string key = name.substr(0, 64);  // limits the untrusted text that is stored
  if (const std::int64_t wait_ms = attempts_.begin(key, peer); wait_ms > 0) {
    return too_many_attempts(wait_ms);
  }
  std::string hashed;
  {
    const std::lock_guard lock(rows_.memory);
    if (const User* const user = rows_.admitted(name)) hashed = user->password;
  }
  HP_ASSIGN_OR_RETURN(const bool right, passwords_.check(password, hashed));
  if (!right)
    return sign_in_failed(
        "the name or the password is wrong; try again, or ask an admin for a sign-in link");
  attempts_.succeeded(key, peer);
  return {};
}

Result<SignedIn> Sessions::sign_in(const std::string& name, const std::string& password,
                                   const std::string& peer) {
  HP_RETURN_IF_ERROR(check_password(name, password, peer));
  HP_ASSIGN_OR_RETURN(const User user, users_.get(name));
  return begin(user, peer);
}

Result<std::pair<std::string, std::int64_t>> Sessions::make_link(const std::string& name) {
  const std::lock_guard writing(rows_.writing);
  HP_RETURN_IF_ERROR(users_.get(name));
  const std::string token = random_hex(kTokenBytes);
  const std::int64_t expire_ms = clock_() + options_.link_ms;
  const Status done = rows_.database.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(rows_.database.run("DELETE FROM sign_in_links WHERE user=?", {name}));
    return rows_.database.run(
        "INSERT INTO sign_in_links(token_hash, user, expire_ms) VALUES (?,?,?)",
        {sha256(token), name, expire_ms});
  });
  HP_RETURN_IF_ERROR(done);
  return std::pair{token, expire_ms};
}

// The row is deleted first, so of two callers with the same link only one finds it. Tokens cannot
// be guessed, so attempts are not limited; each costs only one lookup.
Result<SignedIn> Sessions::sign_in_by_link(const std::string& token, const std::string& peer) {
  const std::string hash = sha256(token.substr(0, kLongestToken));
  const std::lock_guard writing(rows_.writing);
  std::string name;
  HP_RETURN_IF_ERROR(
      rows_.database.each("SELECT user FROM sign_in_links WHERE token_hash=? AND expire_ms>?",
                          {hash, clock_()}, [&](const daemon::DbRow& row) { name = row.text(0); }));
  const auto user = users_.get(name);
  if (!user || user->disabled) {
    attempts_.reject();
    return sign_in_failed(
        "the link was used or replaced, or has expired; ask an admin for another link");
  }
  HP_RETURN_IF_ERROR(rows_.database.run("DELETE FROM sign_in_links WHERE token_hash=?", {hash}));
  return begin(*user, peer);
}

Result<SignedIn> Sessions::begin(const User& user, const std::string& peer) {
  const std::lock_guard writing(rows_.writing);
  HP_RETURN_IF_ERROR(end_oldest(user.name));
  const std::int64_t now_ms = clock_();
  const std::string token = random_hex(kTokenBytes);
  const Session session{
      random_hex(kSessionIdBytes), user.name, sha256(token), peer, now_ms, now_ms};
  HP_RETURN_IF_ERROR(rows_.database.run(
      "INSERT INTO sessions(id, user, token_hash, peer, create_ms, use_ms) VALUES (?,?,?,?,?,?)",
      {session.id, session.user, session.token_hash, session.peer, session.create_ms,
       session.use_ms}));
  const std::lock_guard lock(rows_.memory);
  rows_.sessions[session.token_hash] = session;
  return SignedIn{token, user, session};
}

Status Sessions::end_oldest(const std::string& user) {
  std::vector<Session> all = list(user, "", options_.most);
  if (all.size() < options_.most) return {};
  const auto oldest = std::min_element(
      all.begin(), all.end(), [](const auto& a, const auto& b) { return a.use_ms < b.use_ms; });
  return end(oldest->id);
}

Status Sessions::end_expired() {
  std::vector<std::string> ids;
  {
    const std::lock_guard lock(rows_.memory);
    for (const auto& [hash, session] : rows_.sessions) {
      if (!is_valid(session)) ids.push_back(session.id);
    }
  }
  for (const std::string& id : ids) HP_RETURN_IF_ERROR(end(id));
  return {};
}

std::vector<Session> Sessions::list(const std::string& user, const std::string& after,
                                    std::size_t limit) const {
  std::vector<Session> out;
  {
    const std::lock_guard lock(rows_.memory);
    for (const auto& [hash, session] : rows_.sessions) {
      const bool wanted = (user.empty() || session.user == user) && session.id > after;
      if (wanted && is_valid(session)) out.push_back(session);
    }
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  if (out.size() > limit) out.resize(limit);
  return out;
}

Result<Session> Sessions::get(const std::string& id) const {
  const std::lock_guard lock(rows_.memory);
  for (const auto& [hash, session] : rows_.sessions) {
    if (session.id == id && is_valid(session)) return session;
  }
  return fail(Code::kNotFound, "sessions/" + id + " does not exist",
              ErrorReason::SESSION_NOT_FOUND);
}

Status Sessions::end(const std::string& id) {
  const std::lock_guard writing(rows_.writing);
  HP_RETURN_IF_ERROR(rows_.database.run("DELETE FROM sessions WHERE id=?", {id}));
  const std::lock_guard lock(rows_.memory);
  std::erase_if(rows_.sessions, [&](const auto& entry) { return entry.second.id == id; });
  return {};
}

}  // namespace hydroprint::auth
