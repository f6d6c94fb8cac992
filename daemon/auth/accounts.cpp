#include "daemon/auth/accounts.h"

#include <algorithm>
#include <set>

#include "daemon/auth/secret.h"

namespace hydroprint::auth {
namespace {

constexpr std::size_t kMostUsers = 10000;

tl::unexpected<Error> no_such_user(const std::string& name) {
  return fail(Code::kNotFound, "users/" + name + ": there is no such user", "USER_NOT_FOUND");
}

User read_user(const daemon::DbRow& row) {
  return {row.text(0), static_cast<Role>(row.integer(1)), row.integer(2) != 0, row.text(3),
          row.integer(4)};
}

ApiKey read_key(const daemon::DbRow& row) {
  return {
      row.text(0),    row.text(1),    row.text(2),   row.text(3), static_cast<Role>(row.integer(4)),
      row.integer(5), row.integer(6), row.integer(7)};
}

Session read_session(const daemon::DbRow& row) {
  return {row.text(0), row.text(1), row.text(2), row.text(3), row.integer(4), row.integer(5)};
}

bool is_active_admin(const User& user) { return user.role == Role::kAdmin && !user.disabled; }

}  // namespace

const char* name_of(Role role) {
  switch (role) {
    case Role::kViewer:
      return "VIEWER";
    case Role::kMaker:
      return "MAKER";
    case Role::kOperator:
      return "OPERATOR";
    case Role::kAdmin:
      return "ADMIN";
  }
  return "NONE";
}

Status check_user_name(const std::string& field, const std::string& name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  const auto is_good = [&](char c) {
    return is_plain(c) || std::string_view("._-@+").find(c) != std::string_view::npos;
  };
  if (!name.empty() && name.size() <= 64 && is_plain(name.front()) &&
      std::all_of(name.begin(), name.end(), is_good)) {
    return {};
  }
  auto refused = fail(Code::kInvalidArgument,
                      field +
                          ": must be 1 to 64 letters, digits and . _ - @ +, and begin with a "
                          "letter or digit",
                      field == "name" ? "ID_INVALID" : "SPEC_INVALID");
  refused.value().metadata["field"] = field;
  return refused;
}

Accounts::Accounts(daemon::Database& database, const AccountsOptions& options, daemon::Clock clock)
    : database_(database),
      options_(options),
      clock_(clock),
      passwords_(options.password_cost),
      attempts_(std::move(clock)) {}

Accounts::~Accounts() { (void)clean_up(); }

Result<std::unique_ptr<Accounts>> Accounts::open(daemon::Database& database,
                                                 const AccountsOptions& options,
                                                 daemon::Clock clock) {
  HP_RETURN_IF_ERROR(start_cryptography());
  std::unique_ptr<Accounts> accounts(new Accounts(database, options, std::move(clock)));
  HP_RETURN_IF_ERROR(accounts->reload());
  return accounts;
}

// Callers are identified without waiting for this. The times at which keys and sessions were last
// used are newer in memory than in the rows.
Status Accounts::reload() {
  const std::lock_guard writing(writing_);
  std::map<std::string, User> users;
  std::map<std::string, ApiKey> keys;
  std::unordered_map<std::string, Session> sessions;
  const Status read = database_.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(database_.each("SELECT name, role, disabled, password, create_ms FROM users",
                                      {}, [&](const daemon::DbRow& row) {
                                        User user = read_user(row);
                                        users[user.name] = std::move(user);
                                      }));
    HP_RETURN_IF_ERROR(database_.each(
        "SELECT id, user, display_name, secret_hash, role, create_ms, expire_ms, use_ms FROM "
        "api_keys",
        {}, [&](const daemon::DbRow& row) {
          ApiKey key = read_key(row);
          keys[key.id] = std::move(key);
        }));
    return database_.each("SELECT id, user, token_hash, peer, create_ms, use_ms FROM sessions", {},
                          [&](const daemon::DbRow& row) {
                            Session session = read_session(row);
                            sessions[session.token_hash] = std::move(session);
                          });
  });
  HP_RETURN_IF_ERROR(read);
  const std::lock_guard lock(now_);
  for (auto& [id, key] : keys) {
    if (const auto known = keys_.find(id); known != keys_.end()) {
      key.use_ms = std::max(key.use_ms, known->second.use_ms);
    }
  }
  for (auto& [hash, session] : sessions) {
    if (const auto known = sessions_.find(hash); known != sessions_.end()) {
      session.use_ms = std::max(session.use_ms, known->second.use_ms);
    }
  }
  users_ = std::move(users);
  keys_ = std::move(keys);
  sessions_ = std::move(sessions);
  return {};
}

bool Accounts::any() const {
  const std::lock_guard lock(now_);
  return !users_.empty();
}

Result<bool> Accounts::has_admin_who_can_sign_in() const {
  std::set<std::string> linked;
  HP_RETURN_IF_ERROR(database_.each("SELECT user FROM sign_in_links WHERE expire_ms>?", {clock_()},
                                    [&](const daemon::DbRow& row) { linked.insert(row.text(0)); }));
  const std::lock_guard lock(now_);
  const auto is_admin = [&](const std::string& name) {
    const User* const user = admitted(name);
    return user != nullptr && user->role == Role::kAdmin;
  };
  const std::int64_t now_ms = clock_();
  return std::any_of(users_.begin(), users_.end(),
                     [&](const auto& entry) {
                       const bool is_let_in =
                           !entry.second.password.empty() || linked.contains(entry.first);
                       return is_let_in && is_admin(entry.first);
                     }) ||
         std::any_of(keys_.begin(), keys_.end(),
                     [&](const auto& entry) {
                       const ApiKey& key = entry.second;
                       const bool holds_still = key.expire_ms == 0 || key.expire_ms > now_ms;
                       return holds_still && key.role == Role::kAdmin && is_admin(key.user);
                     }) ||
         std::any_of(sessions_.begin(), sessions_.end(), [&](const auto& entry) {
           return holds(entry.second) && is_admin(entry.second.user);
         });
}

const User* Accounts::admitted(const std::string& name) const {
  const auto found = users_.find(name);
  return found == users_.end() || found->second.disabled ? nullptr : &found->second;
}

Result<User> Accounts::user(const std::string& name) const {
  const std::lock_guard lock(now_);
  const auto found = users_.find(name);
  if (found == users_.end()) return no_such_user(name);
  return found->second;
}

std::vector<User> Accounts::users(const std::string& after, std::size_t limit) const {
  const std::lock_guard lock(now_);
  std::vector<User> out;
  for (auto next = users_.upper_bound(after); next != users_.end() && out.size() < limit; ++next) {
    out.push_back(next->second);
  }
  return out;
}

// Checks that an admin would remain if `instead` replaced the user of that name; null: if the user
// were deleted.
Status Accounts::check_admin_without(const std::string& name, const User* instead) const {
  const std::lock_guard lock(now_);
  if (instead != nullptr && is_active_admin(*instead)) return {};
  for (const auto& [other, user] : users_) {
    if (other != name && is_active_admin(user)) return {};
  }
  return fail(
      Code::kFailedPrecondition,
      "users/" + name + ": there must be at least one active admin; make another user admin first",
      "LAST_ADMIN");
}

Status Accounts::write(const User& user) {
  HP_RETURN_IF_ERROR(database_.run(
      "INSERT INTO users(name, role, disabled, password, create_ms) VALUES (?,?,?,?,?) ON "
      "CONFLICT(name) DO UPDATE SET role=excluded.role, disabled=excluded.disabled, "
      "password=excluded.password",
      {user.name, static_cast<std::int64_t>(user.role), std::int64_t{user.disabled}, user.password,
       user.create_ms}));
  const std::lock_guard lock(now_);
  users_[user.name] = user;
  return {};
}

// A new user gets access to the data stored under their name. Names that were used before there
// were users could be chosen freely, so only the names of deleted users are protected.
Status Accounts::check_name_is_free(const std::string& name) {
  bool is_borne = false;
  HP_RETURN_IF_ERROR(database_.each(
      "SELECT 1 FROM former_users WHERE name=?1 AND (EXISTS (SELECT 1 FROM jobs WHERE owner=?1) OR "
      "EXISTS (SELECT 1 FROM asset_owners WHERE owner=?1) OR EXISTS (SELECT 1 FROM calibrations "
      "WHERE owner=?1) OR EXISTS (SELECT 1 FROM audit WHERE who=?1))",
      {name}, [&](const daemon::DbRow&) { is_borne = true; }));
  if (!is_borne) return {};
  return fail(
      Code::kFailedPrecondition,
      "users/" + name +
          ": a deleted user had this name, and jobs, files or the audit log still refer to it; "
          "choose another name, or confirm that it is the same person (hydroprint users add "
          "--returns)",
      "USER_NAME_USED");
}

Result<User> Accounts::create(const User& user, const std::string& password, bool returns) {
  HP_RETURN_IF_ERROR(check_user_name("user.name", user.name));
  User made = user;
  made.password.clear();
  if (!password.empty()) {
    HP_RETURN_IF_ERROR(check_password_length(password));
    HP_ASSIGN_OR_RETURN(made.password, passwords_.hash(password));
  }
  const std::lock_guard writing(writing_);
  if (this->user(made.name)) {
    return fail(Code::kAlreadyExists,
                "users/" + made.name + ": already exists; choose another name, or change that user",
                "USER_EXISTS");
  }
  HP_RETURN_IF_ERROR(check_admin_without(made.name, &made));
  if (!returns) HP_RETURN_IF_ERROR(check_name_is_free(made.name));
  if (users("", kMostUsers).size() >= kMostUsers) {
    return fail(Code::kResourceExhausted, "too many users; delete some", "KEYS_FULL");
  }
  made.create_ms = clock_();
  HP_RETURN_IF_ERROR(write(made));
  return made;
}

Result<User> Accounts::changed(const std::string& name, const std::function<void(User&)>& change) {
  HP_ASSIGN_OR_RETURN(User user, this->user(name));
  change(user);
  HP_RETURN_IF_ERROR(check_admin_without(name, &user));
  HP_RETURN_IF_ERROR(write(user));
  return user;
}

Result<User> Accounts::update(const std::string& name, const UserChange& change) {
  const std::lock_guard writing(writing_);
  return changed(name, [&](User& user) {
    user.role = change.role.value_or(user.role);
    user.disabled = change.disabled.value_or(user.disabled);
  });
}

Result<User> Accounts::set_password(const std::string& name, const std::string& password,
                                    const std::string& spared) {
  std::string hashed;
  if (!password.empty()) {
    HP_RETURN_IF_ERROR(check_password_length(password));
    HP_ASSIGN_OR_RETURN(hashed, passwords_.hash(password));
  }
  const std::lock_guard writing(writing_);
  HP_ASSIGN_OR_RETURN(User user, changed(name, [&](User& u) { u.password = hashed; }));
  HP_RETURN_IF_ERROR(drop_sessions(
      [&](const Session& session) { return session.user == name && session.id != spared; }));
  HP_RETURN_IF_ERROR(database_.run("DELETE FROM sign_in_links WHERE user=?", {name}));
  return user;
}

Status Accounts::remove(const std::string& name) {
  const std::lock_guard writing(writing_);
  HP_RETURN_IF_ERROR(user(name));
  HP_RETURN_IF_ERROR(check_admin_without(name, nullptr));
  const Status done = database_.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(
        database_.run("INSERT OR REPLACE INTO former_users VALUES (?,?)", {name, clock_()}));
    return database_.run("DELETE FROM users WHERE name=?", {name});  // with dependent rows
  });
  HP_RETURN_IF_ERROR(done);
  const std::lock_guard lock(now_);
  users_.erase(name);
  std::erase_if(keys_, [&](const auto& entry) { return entry.second.user == name; });
  std::erase_if(sessions_, [&](const auto& entry) { return entry.second.user == name; });
  return {};
}

Status Accounts::clean_up() {
  const std::lock_guard writing(writing_);
  HP_RETURN_IF_ERROR(drop_sessions([&](const Session& session) { return !holds(session); }));
  std::map<std::string, ApiKey> keys;
  std::unordered_map<std::string, Session> sessions;
  {
    const std::lock_guard lock(now_);
    keys = keys_;
    sessions = sessions_;
  }
  return database_.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(database_.run("DELETE FROM sign_in_links WHERE expire_ms<=?", {clock_()}));
    for (const auto& [hash, session] : sessions) {
      HP_RETURN_IF_ERROR(database_.run("UPDATE sessions SET use_ms=?1 WHERE id=?2 AND use_ms<>?1",
                                       {session.use_ms, session.id}));
    }
    for (const auto& [id, key] : keys) {
      HP_RETURN_IF_ERROR(database_.run("UPDATE api_keys SET use_ms=?1 WHERE id=?2 AND use_ms<>?1",
                                       {key.use_ms, id}));
    }
    return {};
  });
}

}  // namespace hydroprint::auth
