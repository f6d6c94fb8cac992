#include "daemon/api/services.h"
#include "daemon/auth/authenticator.h"
#include "daemon/auth/secret.h"
#include "daemon/jobs/field_check.h"
#include "daemon/platform/log.h"
#include "daemon/platform/resource_names.h"
#include "daemon/rpc/caller_metadata.h"
#include "daemon/rpc/grpc_status.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/people_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

using auth::Caller;
using auth::Role;

constexpr std::chrono::milliseconds kSignInWritten{2000};  // timeout for writing to the audit log

// Returns the id after the collection's name: "ann" for "users/ann".
Result<std::string> name_in(const std::string& collection, const std::string& name) {
  if (!name.starts_with(collection + "/")) {
    return fail(Code::kInvalidArgument, "name: must have the form " + collection + "/NAME",
                ErrorReason::ID_INVALID);
  }
  std::string id = name.substr(collection.size() + 1);
  HP_RETURN_IF_ERROR(auth::check_user_name("name", id));
  return id;
}

Result<Role> role_in(const char* field, v1::Role role) {
  if (v1::Role_IsValid(role) && role != v1::ROLE_UNSPECIFIED) return static_cast<Role>(role);
  return invalid_field(field, "must be VIEWER, MAKER, OPERATOR or ADMIN");
}

v1::User user_message(const auth::User& user) {
  v1::User out;
  out.set_name("users/" + user.name);
  out.set_role(static_cast<v1::Role>(user.role));
  out.set_disabled(user.disabled);
  out.set_has_password(!user.password.empty());
  *out.mutable_create_time() = time_of(user.create_ms);
  return out;
}

v1::ApiKey key_message(const auth::ApiKey& key) {
  v1::ApiKey out;
  out.set_name("apiKeys/" + key.id);
  out.set_user("users/" + key.user);
  out.set_display_name(key.display_name);
  out.set_role(static_cast<v1::Role>(key.role));
  *out.mutable_create_time() = time_of(key.create_ms);
  if (key.expire_ms != 0) *out.mutable_expire_time() = time_of(key.expire_ms);
  if (key.use_ms != 0) *out.mutable_use_time() = time_of(key.use_ms);
  return out;
}

v1::AuditEntry entry_message(const auth::AuditEntry& entry) {
  v1::AuditEntry out;
  out.set_seq(entry.seq);
  *out.mutable_time() = time_of(entry.time_ms);
  out.set_who(entry.who);
  out.set_via(entry.via);
  out.set_peer(entry.peer);
  out.set_what(entry.what);
  out.set_object(entry.object);
  out.set_outcome(entry.outcome);
  out.set_detail(entry.detail);
  return out;
}

// Returns whether keys and sessions of `owner` are hidden from the caller. Only admins see those of
// other users.
bool is_hidden(const Caller& caller, const std::string& owner) {
  return caller.role < Role::kAdmin && caller.name != owner;
}

class PeopleService final : public v1::PeopleService::Service {
 public:
  explicit PeopleService(const ServiceContext& backend) : backend_(backend) {}

  grpc::Status SignIn(grpc::ServerContext* context, const v1::SignInRequest* request,
                      v1::SignInResponse* reply) override {
    return to_grpc(sign_in(*context, *request, *reply));
  }
  grpc::Status SignOut(grpc::ServerContext* context, const v1::SignOutRequest*,
                       google::protobuf::Empty*) override {
    return to_grpc(sign_out(*context));
  }
  grpc::Status WhoAmI(grpc::ServerContext* context, const v1::WhoAmIRequest*,
                      v1::WhoAmIResponse* reply) override {
    return to_grpc(who(*context, *reply));
  }
  grpc::Status GetUsage(grpc::ServerContext* context, const v1::GetUsageRequest* request,
                        v1::Usage* reply) override {
    return to_grpc(usage(*context, *request, *reply));
  }
  grpc::Status ListUsers(grpc::ServerContext*, const v1::ListUsersRequest* request,
                         v1::ListUsersResponse* reply) override {
    return to_grpc(list_users(*request, *reply));
  }
  grpc::Status CreateUser(grpc::ServerContext*, const v1::CreateUserRequest* request,
                          v1::User* reply) override {
    return answer(create(*request), reply);
  }
  grpc::Status UpdateUser(grpc::ServerContext*, const v1::UpdateUserRequest* request,
                          v1::User* reply) override {
    return answer(update(*request), reply);
  }
  grpc::Status SetPassword(grpc::ServerContext* context, const v1::SetPasswordRequest* request,
                           v1::User* reply) override {
    return answer(set_password(*context, *request), reply);
  }
  grpc::Status CreateSignInLink(grpc::ServerContext*, const v1::CreateSignInLinkRequest* request,
                                v1::SignInLink* reply) override {
    return to_grpc(link(*request, *reply));
  }
  grpc::Status DeleteUser(grpc::ServerContext*, const v1::DeleteUserRequest* request,
                          google::protobuf::Empty*) override {
    const auto name = name_in("users", request->name());
    return name ? to_grpc(backend_.accounts.users().remove(*name)) : to_grpc(name.error());
  }
  grpc::Status ListApiKeys(grpc::ServerContext* context, const v1::ListApiKeysRequest* request,
                           v1::ListApiKeysResponse* reply) override {
    return to_grpc(list_keys(*context, *request, *reply));
  }
  grpc::Status CreateApiKey(grpc::ServerContext* context, const v1::CreateApiKeyRequest* request,
                            v1::CreateApiKeyResponse* reply) override {
    return to_grpc(create_key(*context, *request, *reply));
  }
  grpc::Status DeleteApiKey(grpc::ServerContext* context, const v1::DeleteApiKeyRequest* request,
                            google::protobuf::Empty*) override {
    return to_grpc(delete_key(*context, *request));
  }
  grpc::Status ListSessions(grpc::ServerContext* context, const v1::ListSessionsRequest* request,
                            v1::ListSessionsResponse* reply) override {
    return to_grpc(list_sessions(*context, *request, *reply));
  }
  grpc::Status RevokeSession(grpc::ServerContext* context, const v1::RevokeSessionRequest* request,
                             google::protobuf::Empty*) override {
    return to_grpc(revoke(*context, *request));
  }
  grpc::Status ListAudit(grpc::ServerContext*, const v1::ListAuditRequest* request,
                         v1::ListAuditResponse* reply) override {
    return to_grpc(list_audit(*request, *reply));
  }

 private:
  static grpc::Status answer(const Result<auth::User>& user, v1::User* reply) {
    if (!user) return to_grpc(user.error());
    *reply = user_message(*user);
    return grpc::Status::OK;
  }

  // Attempts rejected by the rate limit are not recorded, because anyone could fill the audit log
  // with them.
  void note_sign_in(const grpc::ServerContext& context, const v1::SignInRequest& request,
                    const Result<auth::SignedIn>& outcome) {
    if (!outcome && outcome.error().reason == ErrorReason::TOO_MANY_ATTEMPTS) return;
    auth::AuditEntry entry;
    entry.via = request.link_token().empty() ? "password" : "link";
    entry.peer = credentials_of(context).peer;
    entry.what = "PeopleService.SignIn";
    entry.outcome = outcome ? "OK" : std::string(code_name(outcome.error().code));
    if (outcome) {
      entry.who = outcome->user.name;
    } else {
      const bool is_name = auth::check_user_name("user", request.user()).has_value();
      if (is_name) entry.object = "users/" + request.user();
      entry.detail = name_of(outcome.error().reason);
      log(LogLevel::kWarning, "sign_in_failed", {{"peer", entry.peer}, {"object", entry.object}});
    }
    const std::uint64_t noted = backend_.audit.note(std::move(entry));
    backend_.audit.wait_written(noted, kSignInWritten);
  }

  Status sign_in(const grpc::ServerContext& context, const v1::SignInRequest& request,
                 v1::SignInResponse& reply) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    if (request.link_token().empty() == request.user().empty()) {
      return invalid_field("user", "set either user and password, or link_token");
    }
    const std::string peer = credentials_of(context).peer;
    const auto in =
        request.link_token().empty()
            ? backend_.accounts.sessions().sign_in(request.user(), request.password(), peer)
            : backend_.accounts.sessions().sign_in_by_link(request.link_token(), peer);
    note_sign_in(context, request, in);
    HP_RETURN_IF_ERROR(in);
    reply.set_session_token(in->token);
    reply.set_csrf_token(auth::csrf_token(in->token));
    *reply.mutable_user() = user_message(in->user);
    *reply.mutable_expire_time() = time_of(backend_.accounts.sessions().most_ms(in->session));
    return {};
  }

  Status sign_out(const grpc::ServerContext& context) {
    HP_ASSIGN_OR_RETURN(const Caller caller, caller_of(context));
    return caller.session.empty() ? Status() : backend_.accounts.sessions().end(caller.session);
  }

  Status who(const grpc::ServerContext& context, v1::WhoAmIResponse& reply) {
    HP_ASSIGN_OR_RETURN(const Caller caller, caller_of(context));
    reply.set_user(caller.name);
    reply.set_role(static_cast<v1::Role>(caller.role));
    reply.set_via(caller.via);
    reply.set_accounts(caller.is_user);
    if (!caller.session.empty()) {
      reply.set_csrf_token(auth::csrf_token(caller.credentials.session));
    }
    const auto user = backend_.accounts.users().get(caller.name);
    reply.set_has_password(user && !user->password.empty());
    return {};
  }

  Status usage(const grpc::ServerContext& context, const v1::GetUsageRequest& request,
               v1::Usage& reply) {
    HP_ASSIGN_OR_RETURN(const Caller caller, caller_of(context));
    const std::string& owner = request.owner().empty() ? caller.name : request.owner();
    if (owner != caller.name) HP_RETURN_IF_ERROR(check_role(caller, Role::kAdmin));
    HP_ASSIGN_OR_RETURN(const Usage usage, usage_of(backend_.database, owner));
    reply.set_owner(owner);
    reply.set_queued_jobs(usage.queued_jobs);
    reply.set_max_queued_jobs(backend_.quota.max_queued_jobs);
    reply.set_stored_bytes(usage.stored_bytes);
    reply.set_max_stored_bytes(backend_.quota.max_stored_bytes);
    reply.set_pinned_bytes(usage.pinned_bytes);
    return {};
  }

  Status list_users(const v1::ListUsersRequest& request, v1::ListUsersResponse& reply) {
    HP_ASSIGN_OR_RETURN(const int size, page_size(request.page_size(), 50));
    auto users =
        backend_.accounts.users().list(request.page_token(), static_cast<std::size_t>(size) + 1);
    if (cut_page(users, size)) reply.set_next_page_token(users.back().name);
    for (const auth::User& user : users) *reply.add_users() = user_message(user);
    return {};
  }

  Result<auth::User> create(const v1::CreateUserRequest& request) {
    HP_ASSIGN_OR_RETURN(const std::string name, name_in("users", request.user().name()));
    HP_ASSIGN_OR_RETURN(const Role role, role_in("user.role", request.user().role()));
    return backend_.accounts.users().create({name, role, request.user().disabled(), "", 0},
                                            request.password(), request.returns());
  }

  Result<auth::User> update(const v1::UpdateUserRequest& request) {
    HP_ASSIGN_OR_RETURN(const std::string name, name_in("users", request.name()));
    auth::UserChange change;
    if (request.has_role()) {
      HP_ASSIGN_OR_RETURN(change.role, role_in("role", request.role()));
    }
    if (request.has_disabled()) change.disabled = request.disabled();
    return backend_.accounts.users().update(name, change);
  }

  Result<auth::User> set_password(const grpc::ServerContext& context,
                                  const v1::SetPasswordRequest& request) {
    HP_ASSIGN_OR_RETURN(const std::string name, name_in("users", request.name()));
    HP_ASSIGN_OR_RETURN(const Caller caller, caller_of(context));
    const bool is_own = caller.name == name && caller.is_user;
    if (!is_own) HP_RETURN_IF_ERROR(check_role(caller, Role::kAdmin));
    HP_ASSIGN_OR_RETURN(const auth::User user, backend_.accounts.users().get(name));
    if (is_own) {
      if (request.new_password().empty()) return invalid_field("new_password", "is missing");
      HP_RETURN_IF_ERROR(check_old_password(caller, user, request.old_password(), context));
    }
    return backend_.accounts.users().set_password(name, request.new_password(), caller.session);
  }

  // A user without a password needs a session, which a sign-in link has started. An API key is not
  // sufficient: it may have a lower role than its user, who gets the full role by signing in with
  // the password.
  Status check_old_password(const Caller& caller, const auth::User& user,
                            const std::string& password, const grpc::ServerContext& context) {
    if (user.password.empty() && !caller.session.empty()) return {};
    const Status right = backend_.accounts.sessions().check_password(user.name, password,
                                                                     credentials_of(context).peer);
    if (right || right.error().code != Code::kUnauthenticated) return right;
    return fail(Code::kPermissionDenied,
                "old_password: wrong password; if you have forgotten it, ask an admin to reset it",
                ErrorReason::SIGN_IN_FAILED);
  }

  Status link(const v1::CreateSignInLinkRequest& request, v1::SignInLink& reply) {
    HP_ASSIGN_OR_RETURN(const std::string name, name_in("users", request.name()));
    HP_ASSIGN_OR_RETURN(const auto token_and_expiry, backend_.accounts.sessions().make_link(name));
    reply.set_token(token_and_expiry.first);
    *reply.mutable_expire_time() = time_of(token_and_expiry.second);
    return {};
  }

  // Returns the user whose keys or sessions are to be listed; empty: all users. Only admins may
  // list those of other users.
  static Result<std::string> wanted(const Caller& caller, const std::string& user) {
    if (user.empty()) return caller.role == Role::kAdmin ? std::string() : caller.name;
    HP_ASSIGN_OR_RETURN(std::string name, name_in("users", user));
    if (name != caller.name) HP_RETURN_IF_ERROR(check_role(caller, Role::kAdmin));
    return name;
  }

  Status list_keys(const grpc::ServerContext& context, const v1::ListApiKeysRequest& request,
                   v1::ListApiKeysResponse& reply) {
    HP_ASSIGN_OR_RETURN(const Caller caller, caller_of(context));
    HP_ASSIGN_OR_RETURN(const int size, page_size(request.page_size(), 50));
    HP_ASSIGN_OR_RETURN(const std::string user, wanted(caller, request.user()));
    auto keys = backend_.accounts.keys().list(user, request.page_token(),
                                              static_cast<std::size_t>(size) + 1);
    if (cut_page(keys, size)) reply.set_next_page_token(keys.back().id);
    for (const auth::ApiKey& key : keys) *reply.add_api_keys() = key_message(key);
    return {};
  }

  Status create_key(const grpc::ServerContext& context, const v1::CreateApiKeyRequest& request,
                    v1::CreateApiKeyResponse& reply) {
    HP_ASSIGN_OR_RETURN(const Caller caller, caller_of(context));
    if (!caller.is_user) {
      return fail(Code::kFailedPrecondition,
                  "there are no users yet, so keys are not needed; create a user first",
                  ErrorReason::STATE_FORBIDS);
    }
    HP_RETURN_IF_ERROR(check_fields(request));
    auth::NewKey new_key{caller.name, request.display_name(), caller.role, 0};
    if (request.has_role()) {
      HP_ASSIGN_OR_RETURN(new_key.role, role_in("role", request.role()));
      HP_RETURN_IF_ERROR(check_role(caller, new_key.role));
    }
    if (request.has_ttl()) new_key.ttl_ms = request.ttl().seconds() * 1000;
    HP_ASSIGN_OR_RETURN(const auto key, backend_.accounts.keys().create(new_key));
    *reply.mutable_api_key() = key_message(key.first);
    reply.set_key(key.second);
    return {};
  }

  Status delete_key(const grpc::ServerContext& context, const v1::DeleteApiKeyRequest& request) {
    HP_ASSIGN_OR_RETURN(const Caller caller, caller_of(context));
    HP_ASSIGN_OR_RETURN(const std::string id, name_in("apiKeys", request.name()));
    const auto key = backend_.accounts.keys().get(id);
    if (!key || is_hidden(caller, key->user)) {
      return fail(Code::kNotFound, request.name() + " does not exist, or belongs to another user",
                  ErrorReason::KEY_NOT_FOUND);
    }
    return backend_.accounts.keys().remove(id);
  }

  Status list_sessions(const grpc::ServerContext& context, const v1::ListSessionsRequest& request,
                       v1::ListSessionsResponse& reply) {
    HP_ASSIGN_OR_RETURN(const Caller caller, caller_of(context));
    HP_ASSIGN_OR_RETURN(const int size, page_size(request.page_size(), 50));
    HP_ASSIGN_OR_RETURN(const std::string user, wanted(caller, request.user()));
    auto sessions = backend_.accounts.sessions().list(user, request.page_token(),
                                                      static_cast<std::size_t>(size) + 1);
    if (cut_page(sessions, size)) reply.set_next_page_token(sessions.back().id);
    for (const auth::Session& session : sessions) {
      v1::Session& out = *reply.add_sessions();
      out.set_name("sessions/" + session.id);
      out.set_user("users/" + session.user);
      *out.mutable_create_time() = time_of(session.create_ms);
      *out.mutable_use_time() = time_of(session.use_ms);
      *out.mutable_expire_time() = time_of(backend_.accounts.sessions().expire_ms(session));
      out.set_peer(session.peer);
      out.set_current(session.id == caller.session);
    }
    return {};
  }

  Status revoke(const grpc::ServerContext& context, const v1::RevokeSessionRequest& request) {
    HP_ASSIGN_OR_RETURN(const Caller caller, caller_of(context));
    HP_ASSIGN_OR_RETURN(const std::string id, name_in("sessions", request.name()));
    const auto session = backend_.accounts.sessions().get(id);
    if (!session || is_hidden(caller, session->user)) {
      return fail(Code::kNotFound, request.name() + " does not exist, or belongs to another user",
                  ErrorReason::SESSION_NOT_FOUND);
    }
    return backend_.accounts.sessions().end(id);
  }

  Status list_audit(const v1::ListAuditRequest& request, v1::ListAuditResponse& reply) {
    HP_ASSIGN_OR_RETURN(const int size, page_size(request.page_size(), 50));
    auth::AuditFilter filter{request.who(), request.what(), 0, size + 1};
    HP_ASSIGN_OR_RETURN(filter.before, number_token(request.page_token()));
    HP_ASSIGN_OR_RETURN(auto entries, backend_.audit.list(filter));
    if (cut_page(entries, size)) reply.set_next_page_token(std::to_string(entries.back().seq));
    for (const auth::AuditEntry& entry : entries) *reply.add_entries() = entry_message(entry);
    return {};
  }

  ServiceContext backend_;
};

}  // namespace

std::unique_ptr<grpc::Service> make_people_service(const ServiceContext& backend) {
  return std::make_unique<PeopleService>(backend);
}

}  // namespace hydroprint::daemon
