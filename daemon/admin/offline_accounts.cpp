#include "daemon/admin/offline_accounts.h"

#include "daemon/auth/accounts.h"
#include "daemon/auth/external_changes.h"
#include "daemon/platform/clock.h"

namespace hydroprint::admin {
namespace {

Result<std::unique_ptr<auth::Accounts>> accounts_of(State& state) {
  return auth::Accounts::open(*state.database, {}, daemon::system_clock_ms);
}

}  // namespace

Status reset_password(State& state, const std::string& user, const std::string& password) {
  if (password.empty()) {
    return fail(Code::kInvalidArgument, "the password is empty; use at least 10 bytes");
  }
  HP_ASSIGN_OR_RETURN(const auto accounts, accounts_of(state));
  HP_RETURN_IF_ERROR(accounts->users().set_password(user, password, ""));
  HP_RETURN_IF_ERROR(note(*state.database, "reset-password", "users/" + user));
  HP_ASSIGN_OR_RETURN(const std::string word, auth::tell_daemon(*state.database));
  return state.daemon_runs() ? auth::wait_for_daemon(*state.database, word) : Status();
}

Result<std::string> sign_in_link(State& state, const std::string& user) {
  HP_ASSIGN_OR_RETURN(const auto accounts, accounts_of(state));
  HP_ASSIGN_OR_RETURN(const auth::User found, accounts->users().get(user));
  if (found.disabled) {
    return fail(Code::kFailedPrecondition,
                "users/" + user + ": this user is disabled; an admin must enable the user first");
  }
  HP_ASSIGN_OR_RETURN(const auto link, accounts->sessions().make_link(user));
  HP_RETURN_IF_ERROR(note(*state.database, "sign-in-link", "users/" + user));
  return link.first;
}

}  // namespace hydroprint::admin
