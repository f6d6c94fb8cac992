#include "daemon/auth/users.h"

#include <algorithm>

namespace hydroprint::auth {
namespace {

constexpr std::size_t kMostUsers = 10000;

tl::unexpected<Error> no_such_user(const std::string& name) {
  return fail(Code::kNotFound, "users/" + name + ": unknown user", ErrorReason::USER_NOT_FOUND);
}

bool is_active_admin(const User& user) { return user.role == Role::kAdmin && !user.disabled; }

}  // namespace

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
  return fail_field(
      Code::kInvalidArgument, field,
      "must be 1 to 64 letters, digits and . _ - @ +, and begin with a letter or digit",
      field == "name" ? ErrorReason::ID_INVALID : ErrorReason::SPEC_INVALID);
}

bool Users::any() const {
  const std::lock_guard lock(rows_.memory);
  return !rows_.users.empty();
}

Result<User> Users::get(const std::string& name) const {
  const std::lock_guard lock(rows_.memory);
  const auto found = rows_.users.find(name);
  if (found == rows_.users.end()) return no_such_user(name);
  return found->second;
}

std::vector<User> Users::list(const std::string& after, std::size_t limit) const {
  const std::lock_guard lock(rows_.memory);
  std::vector<User> out;
  for (auto next = rows_.users.upper_bound(after); next != rows_.users.end() && out.size() < limit;
       ++next) {
    out.push_back(next->second);
  }
  return out;
}

// Checks that an active admin remains if `instead` replaces the user of that name, or, if it is
// null, if the user is deleted.
Status Users::check_admin_without(const std::string& name, const User* instead) const {
  const std::lock_guard lock(rows_.memory);
  if (instead != nullptr && is_active_admin(*instead)) return {};
  for (const auto& [other, user] : rows_.users) {
    if (other != name && is_active_admin(user)) return {};
  }
  return fail(
      Code::kFailedPrecondition,
      "users/" + name + ": there must be at least one active admin; make another user admin first",
      ErrorReason::LAST_ADMIN);
}

Status Users::write(const User& user) {
  HP_RETURN_IF_ERROR(rows_.database.run(
      "INSERT INTO users(name, role, disabled, password, create_ms) VALUES (?,?,?,?,?) ON "
      "CONFLICT(name) DO UPDATE SET role=excluded.role, disabled=excluded.disabled, "
      "password=excluded.password",
      {user.name, static_cast<std::int64_t>(user.role), std::int64_t{user.disabled}, user.password,
       user.create_ms}));
  const std::lock_guard lock(rows_.memory);
  rows_.users[user.name] = user;
  return {};
}

// A new user may use the data stored under their name. Before there were users, callers chose their
// names themselves, so this data is assumed to be theirs. Only the name of a deleted user may have
// belonged to somebody else.
Status Users::check_name_is_free(const std::string& name) {
  bool is_borne = false;
  HP_RETURN_IF_ERROR(rows_.database.each(
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
      ErrorReason::USER_NAME_USED);
}

Result<User> Users::create(const User& user, const std::string& password, bool returns) {
  HP_RETURN_IF_ERROR(check_user_name("user.name", user.name));
  User created = user;
  created.password.clear();
  if (!password.empty()) {
    HP_RETURN_IF_ERROR(check_password_length(password));
    HP_ASSIGN_OR_RETURN(created.password, passwords_.hash(password));
  }
  const std::lock_guard writing(rows_.writing);
  if (get(created.name)) {
    return fail(
        Code::kAlreadyExists,
        "users/" + created.name + ": already exists; choose another name, or change that user",
        ErrorReason::USER_EXISTS);
  }
  HP_RETURN_IF_ERROR(check_admin_without(created.name, &created));
  if (!returns) HP_RETURN_IF_ERROR(check_name_is_free(created.name));
  if (list("", kMostUsers).size() >= kMostUsers) {
    return fail(Code::kResourceExhausted, "too many users; delete some", ErrorReason::KEYS_FULL);
  }
  created.create_ms = clock_();
  HP_RETURN_IF_ERROR(write(created));
  return created;
}

Result<User> Users::changed(const std::string& name, const std::function<void(User&)>& change) {
  HP_ASSIGN_OR_RETURN(User user, get(name));
  change(user);
  HP_RETURN_IF_ERROR(check_admin_without(name, &user));
  HP_RETURN_IF_ERROR(write(user));
  return user;
}

Result<User> Users::update(const std::string& name, const UserChange& change) {
  const std::lock_guard writing(rows_.writing);
  return changed(name, [&](User& user) {
    user.role = change.role.value_or(user.role);
    user.disabled = change.disabled.value_or(user.disabled);
  });
}

Result<User> Users::set_password(const std::string& name, const std::string& password,
                                 const std::string& spared) {
  std::string hashed;
  if (!password.empty()) {
    HP_RETURN_IF_ERROR(check_password_length(password));
    HP_ASSIGN_OR_RETURN(hashed, passwords_.hash(password));
  }
  const std::lock_guard writing(rows_.writing);
  HP_ASSIGN_OR_RETURN(User user, changed(name, [&](User& u) { u.password = hashed; }));
  const Status done = rows_.database.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(
        rows_.database.run("DELETE FROM sessions WHERE user=? AND id<>?", {name, spared}));
    return rows_.database.run("DELETE FROM sign_in_links WHERE user=?", {name});
  });
  HP_RETURN_IF_ERROR(done);
  const std::lock_guard lock(rows_.memory);
  std::erase_if(rows_.sessions, [&](const auto& entry) {
    return entry.second.user == name && entry.second.id != spared;
  });
  return user;
}

Status Users::remove(const std::string& name) {
  const std::lock_guard writing(rows_.writing);
  HP_RETURN_IF_ERROR(get(name));
  HP_RETURN_IF_ERROR(check_admin_without(name, nullptr));
  const Status done = rows_.database.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(
        rows_.database.run("INSERT OR REPLACE INTO former_users VALUES (?,?)", {name, clock_()}));
    return rows_.database.run("DELETE FROM users WHERE name=?",
                              {name});  // also deletes dependent rows
  });
  HP_RETURN_IF_ERROR(done);
  const std::lock_guard lock(rows_.memory);
  rows_.users.erase(name);
  std::erase_if(rows_.keys, [&](const auto& entry) { return entry.second.user == name; });
  std::erase_if(rows_.sessions, [&](const auto& entry) { return entry.second.user == name; });
  return {};
}

}  // namespace hydroprint::auth
