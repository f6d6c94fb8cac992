#include <algorithm>

#include "daemon/auth/accounts.h"
#include "daemon/auth/secret.h"
#include "sim/base/sha256.h"

namespace hydroprint::auth {
namespace {

constexpr std::size_t kTokenBytes = 32;
constexpr std::size_t kSessionIdBytes = 8;
constexpr std::size_t kLongestToken = 1000;

tl::unexpected<Error> sign_in_failed(const char* what) {
  return fail(Code::kUnauthenticated, what, "SIGN_IN_FAILED");
}

tl::unexpected<Error> too_many_attempts(std::int64_t wait_ms) {
  const std::string seconds = std::to_string((wait_ms + 999) / 1000);
  auto refused = fail(Code::kResourceExhausted,
                      "too many attempts to sign in failed; try again in " + seconds + " s",
                      "TOO_MANY_ATTEMPTS");
  refused.value().metadata["retry_s"] = seconds;
  return refused;
}

}  // namespace

std::int64_t Accounts::expire_ms(const Session& session) const {
  return std::min(session.use_ms + options_.session_idle_ms, most_ms(session));
}

bool Accounts::holds(const Session& session) const { return clock_() < expire_ms(session); }

std::optional<Caller> Accounts::by_session(std::string_view token, bool is_use) {
  if (token.size() > kLongestToken) return std::nullopt;
  const std::string hash = sha256(token);
  const std::lock_guard lock(now_);
  const auto found = sessions_.find(hash);
  if (found == sessions_.end() || !holds(found->second)) return std::nullopt;
  const User* const user = admitted(found->second.user);
  if (user == nullptr) return std::nullopt;
  if (is_use) found->second.use_ms = clock_();
  return Caller{user->name, user->role, "session", found->second.id, true};
}

Status Accounts::check_password(const std::string& name, const std::string& password,
                                const std::string& peer) {
  const std::string key = name.substr(0, 64);  // stores no more than this of untrusted text
  if (const std::int64_t wait_ms = attempts_.begin(key, peer); wait_ms > 0) {
    return too_many_attempts(wait_ms);
  }
  std::string hashed;
  {
    const std::lock_guard lock(now_);
    if (const User* const user = admitted(name)) hashed = user->password;
  }
  HP_ASSIGN_OR_RETURN(const bool right, passwords_.check(password, hashed));
  if (!right) return sign_in_failed("the name or the password is wrong; ask an admin for a link");
  attempts_.succeeded(key, peer);
  return {};
}

Result<SignedIn> Accounts::sign_in(const std::string& name, const std::string& password,
                                   const std::string& peer) {
  HP_RETURN_IF_ERROR(check_password(name, password, peer));
  HP_ASSIGN_OR_RETURN(const User user, this->user(name));
  return begin_session(user, peer);
}

Result<std::pair<std::string, std::int64_t>> Accounts::make_link(const std::string& name) {
  const std::lock_guard writing(writing_);
  HP_RETURN_IF_ERROR(user(name));
  const std::string token = random_hex(kTokenBytes);
  const std::int64_t expire_ms = clock_() + options_.link_ms;
  const Status done = database_.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(database_.run("DELETE FROM sign_in_links WHERE user=?", {name}));
    return database_.run("INSERT INTO sign_in_links(token_hash, user, expire_ms) VALUES (?,?,?)",
                         {sha256(token), name, expire_ms});
  });
  HP_RETURN_IF_ERROR(done);
  return std::pair{token, expire_ms};
}

// The row is deleted first, so only one of two callers with the same link finds it. Tokens cannot
// be guessed and each attempt costs only one lookup, so attempts are not limited.
Result<SignedIn> Accounts::sign_in_by_link(const std::string& token, const std::string& peer) {
  const std::string hash = sha256(token.substr(0, kLongestToken));
  const std::lock_guard writing(writing_);
  std::string name;
  HP_RETURN_IF_ERROR(
      database_.each("SELECT user FROM sign_in_links WHERE token_hash=? AND expire_ms>?",
                     {hash, clock_()}, [&](const daemon::DbRow& row) { name = row.text(0); }));
  const auto user = this->user(name);
  if (!user || user->disabled) {
    attempts_.reject();
    return sign_in_failed(
        "the link was used or replaced, or has expired; ask an admin for another");
  }
  HP_RETURN_IF_ERROR(database_.run("DELETE FROM sign_in_links WHERE token_hash=?", {hash}));
  return begin_session(*user, peer);
}

Result<SignedIn> Accounts::begin_session(const User& user, const std::string& peer) {
  const std::lock_guard writing(writing_);
  HP_RETURN_IF_ERROR(drop_oldest_session(user.name));
  const std::int64_t now_ms = clock_();
  const std::string token = random_hex(kTokenBytes);
  const Session session{
      random_hex(kSessionIdBytes), user.name, sha256(token), peer, now_ms, now_ms};
  HP_RETURN_IF_ERROR(database_.run(
      "INSERT INTO sessions(id, user, token_hash, peer, create_ms, use_ms) VALUES (?,?,?,?,?,?)",
      {session.id, session.user, session.token_hash, session.peer, session.create_ms,
       session.use_ms}));
  const std::lock_guard lock(now_);
  sessions_[session.token_hash] = session;
  return SignedIn{token, user, session};
}

Status Accounts::drop_oldest_session(const std::string& user) {
  std::vector<Session> all = sessions(user, "", options_.most_sessions);
  if (all.size() < options_.most_sessions) return {};
  const auto oldest = std::min_element(
      all.begin(), all.end(), [](const auto& a, const auto& b) { return a.use_ms < b.use_ms; });
  return end_session(oldest->id);
}

Status Accounts::drop_sessions(const std::function<bool(const Session&)>& which) {
  std::vector<std::string> ids;
  {
    const std::lock_guard lock(now_);
    for (const auto& [hash, session] : sessions_) {
      if (which(session)) ids.push_back(session.id);
    }
  }
  for (const std::string& id : ids) HP_RETURN_IF_ERROR(end_session(id));
  return {};
}

std::vector<Session> Accounts::sessions(const std::string& user, const std::string& after,
                                        std::size_t limit) const {
  std::vector<Session> out;
  {
    const std::lock_guard lock(now_);
    for (const auto& [hash, session] : sessions_) {
      const bool wanted = (user.empty() || session.user == user) && session.id > after;
      if (wanted && holds(session)) out.push_back(session);
    }
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  if (out.size() > limit) out.resize(limit);
  return out;
}

Result<Session> Accounts::session(const std::string& id) const {
  const std::lock_guard lock(now_);
  for (const auto& [hash, session] : sessions_) {
    if (session.id == id && holds(session)) return session;
  }
  return fail(Code::kNotFound, "sessions/" + id + ": there is no such session",
              "SESSION_NOT_FOUND");
}

Status Accounts::end_session(const std::string& id) {
  const std::lock_guard writing(writing_);
  HP_RETURN_IF_ERROR(database_.run("DELETE FROM sessions WHERE id=?", {id}));
  const std::lock_guard lock(now_);
  std::erase_if(sessions_, [&](const auto& entry) { return entry.second.id == id; });
  return {};
}

}  // namespace hydroprint::auth
