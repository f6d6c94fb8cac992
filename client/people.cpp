#include "client/people.h"

#include <google/protobuf/util/time_util.h>

#include <algorithm>

#include "client/connection/rpc.h"
#include "client/convert.h"

namespace hydroprint::client {
namespace {

using PeopleStub = v1::PeopleService::Stub;

std::string role_text(v1::Role role) { return v1::Role_Name(role); }

Result<v1::Role> role_of(const std::string& text) {
  v1::Role role{};
  if (v1::Role_Parse(text, &role)) return role;
  return fail(Code::kInvalidArgument, text + ": unknown role; use VIEWER, MAKER, OPERATOR or ADMIN",
              "SPEC_INVALID");
}

User to_user(const v1::User& user) {
  return {user.name(), role_text(user.role()), user.disabled(), user.has_password(),
          from_proto(user.has_create_time(), user.create_time())};
}

ApiKey to_key(const v1::ApiKey& key) {
  return {key.name(),
          key.user(),
          key.display_name(),
          role_text(key.role()),
          from_proto(key.has_create_time(), key.create_time()),
          from_proto(key.has_expire_time(), key.expire_time()),
          from_proto(key.has_use_time(), key.use_time())};
}

Session to_session(const v1::Session& session) {
  return {session.name(),
          session.user(),
          from_proto(session.has_create_time(), session.create_time()),
          from_proto(session.has_use_time(), session.use_time()),
          from_proto(session.has_expire_time(), session.expire_time()),
          session.peer(),
          session.current()};
}

AuditEntry to_entry(const v1::AuditEntry& entry) {
  return {from_proto(entry.has_time(), entry.time()),
          entry.who(),
          entry.via(),
          entry.peer(),
          entry.what(),
          entry.object(),
          entry.outcome(),
          entry.detail()};
}

PeopleStub& stub(Connection& connection) { return *connection.impl().people; }

// Requests pages until `take` returns false or no page is left.
template <class Request, class Response, class Take>
Status all_pages(Connection& connection,
                 grpc::Status (PeopleStub::*method)(grpc::ClientContext*, const Request&,
                                                    Response*),
                 Request request, const Take& take) {
  request.set_page_size(kPageSize);
  for (;;) {
    HP_ASSIGN_OR_RETURN(const Response page, call(connection, stub(connection), method, request));
    if (!take(page) || page.next_page_token().empty()) return {};
    request.set_page_token(page.next_page_token());
  }
}

// client:: is required: protobuf has a call_once too, found through its message arguments.

// Sends a request that holds only a name and expects an empty response.
template <class Request>
Status by_name(Connection& connection, const std::string& name,
               grpc::Status (PeopleStub::*method)(grpc::ClientContext*, const Request&,
                                                  google::protobuf::Empty*)) {
  Request request;
  request.set_name(name);
  HP_RETURN_IF_ERROR(client::call_once(connection, stub(connection), method, request));
  return {};
}

}  // namespace

std::vector<std::string> role_names() { return {"VIEWER", "MAKER", "OPERATOR", "ADMIN"}; }

namespace {

Result<std::string> begin_session(Connection& connection, const v1::SignInRequest& request) {
  HP_RETURN_IF_ERROR(check_secrets_may_go(connection.options()));
  HP_ASSIGN_OR_RETURN(
      const v1::SignInResponse reply,
      client::call_once(connection, stub(connection), &PeopleStub::SignIn, request));
  return reply.session_token();
}

}  // namespace

Result<std::string> sign_in(Connection& connection, const std::string& user,
                            const std::string& password) {
  v1::SignInRequest request;
  request.set_user(user);
  request.set_password(password);
  return begin_session(connection, request);
}

Result<std::string> sign_in_by_link(Connection& connection, const std::string& token) {
  v1::SignInRequest request;
  request.set_link_token(token);
  return begin_session(connection, request);
}

Status sign_out(Connection& connection) {
  HP_RETURN_IF_ERROR(
      client::call_once(connection, stub(connection), &PeopleStub::SignOut, v1::SignOutRequest()));
  return {};
}

Result<Identity> who_am_i(Connection& connection) {
  HP_ASSIGN_OR_RETURN(const v1::WhoAmIResponse reply,
                      call(connection, stub(connection), &PeopleStub::WhoAmI, v1::WhoAmIRequest()));
  return Identity{reply.user(), role_text(reply.role()), reply.via(), reply.accounts()};
}

Result<Usage> get_usage(Connection& connection) {
  HP_ASSIGN_OR_RETURN(const v1::Usage usage, call(connection, stub(connection),
                                                  &PeopleStub::GetUsage, v1::GetUsageRequest()));
  return Usage{usage.owner(),        usage.queued_jobs(),      usage.max_queued_jobs(),
               usage.stored_bytes(), usage.max_stored_bytes(), usage.pinned_bytes()};
}

Result<std::vector<User>> list_users(Connection& connection) {
  std::vector<User> users;
  HP_RETURN_IF_ERROR(all_pages(connection, &PeopleStub::ListUsers, v1::ListUsersRequest(),
                               [&](const v1::ListUsersResponse& page) {
                                 std::transform(page.users().begin(), page.users().end(),
                                                std::back_inserter(users), to_user);
                                 return true;
                               }));
  return users;
}

Result<User> create_user(Connection& connection, const std::string& name, const std::string& role,
                         const std::string& password, bool returns) {
  HP_RETURN_IF_ERROR(check_secrets_may_go(connection.options()));
  v1::CreateUserRequest request;
  request.set_returns(returns);
  request.mutable_user()->set_name(name);
  HP_ASSIGN_OR_RETURN(const v1::Role wanted, role_of(role));
  request.mutable_user()->set_role(wanted);
  request.set_password(password);
  HP_ASSIGN_OR_RETURN(const v1::User user, client::call_once(connection, stub(connection),
                                                             &PeopleStub::CreateUser, request));
  return to_user(user);
}

Result<User> update_user(Connection& connection, const std::string& name,
                         const std::optional<std::string>& role, std::optional<bool> disabled) {
  v1::UpdateUserRequest request;
  request.set_name(name);
  if (role) {
    HP_ASSIGN_OR_RETURN(const v1::Role wanted, role_of(*role));
    request.set_role(wanted);
  }
  if (disabled) request.set_disabled(*disabled);
  HP_ASSIGN_OR_RETURN(const v1::User user,
                      call(connection, stub(connection), &PeopleStub::UpdateUser, request));
  return to_user(user);
}

Result<User> set_password(Connection& connection, const std::string& name,
                          const std::string& old_password, const std::string& new_password) {
  HP_RETURN_IF_ERROR(check_secrets_may_go(connection.options()));
  v1::SetPasswordRequest request;
  request.set_name(name);
  request.set_old_password(old_password);
  request.set_new_password(new_password);
  HP_ASSIGN_OR_RETURN(const v1::User user, client::call_once(connection, stub(connection),
                                                             &PeopleStub::SetPassword, request));
  return to_user(user);
}

Result<std::string> create_sign_in_link(Connection& connection, const std::string& name) {
  v1::CreateSignInLinkRequest request;
  request.set_name(name);
  HP_ASSIGN_OR_RETURN(
      const v1::SignInLink link,
      client::call_once(connection, stub(connection), &PeopleStub::CreateSignInLink, request));
  return link.token();
}

Status delete_user(Connection& connection, const std::string& name) {
  return by_name(connection, name, &PeopleStub::DeleteUser);
}

Result<std::vector<ApiKey>> list_api_keys(Connection& connection) {
  std::vector<ApiKey> keys;
  HP_RETURN_IF_ERROR(all_pages(connection, &PeopleStub::ListApiKeys, v1::ListApiKeysRequest(),
                               [&](const v1::ListApiKeysResponse& page) {
                                 std::transform(page.api_keys().begin(), page.api_keys().end(),
                                                std::back_inserter(keys), to_key);
                                 return true;
                               }));
  return keys;
}

Result<NewApiKey> create_api_key(Connection& connection, const std::string& display_name,
                                 const std::string& role, std::chrono::seconds ttl) {
  v1::CreateApiKeyRequest request;
  request.set_display_name(display_name);
  if (!role.empty()) {
    HP_ASSIGN_OR_RETURN(const v1::Role wanted, role_of(role));
    request.set_role(wanted);
  }
  if (ttl.count() > 0) request.mutable_ttl()->set_seconds(ttl.count());
  HP_ASSIGN_OR_RETURN(
      const v1::CreateApiKeyResponse reply,
      client::call_once(connection, stub(connection), &PeopleStub::CreateApiKey, request));
  return NewApiKey{to_key(reply.api_key()), reply.key()};
}

Status delete_api_key(Connection& connection, const std::string& name) {
  return by_name(connection, name, &PeopleStub::DeleteApiKey);
}

Result<std::vector<Session>> list_sessions(Connection& connection) {
  std::vector<Session> sessions;
  HP_RETURN_IF_ERROR(all_pages(connection, &PeopleStub::ListSessions, v1::ListSessionsRequest(),
                               [&](const v1::ListSessionsResponse& page) {
                                 std::transform(page.sessions().begin(), page.sessions().end(),
                                                std::back_inserter(sessions), to_session);
                                 return true;
                               }));
  return sessions;
}

Status revoke_session(Connection& connection, const std::string& name) {
  return by_name(connection, name, &PeopleStub::RevokeSession);
}

Result<std::vector<AuditEntry>> list_audit(Connection& connection, const std::string& who,
                                           const std::string& what, int limit) {
  v1::ListAuditRequest request;
  request.set_who(who);
  request.set_what(what);
  std::vector<AuditEntry> entries;
  HP_RETURN_IF_ERROR(all_pages(connection, &PeopleStub::ListAudit, request,
                               [&](const v1::ListAuditResponse& page) {
                                 std::transform(page.entries().begin(), page.entries().end(),
                                                std::back_inserter(entries), to_entry);
                                 return std::ssize(entries) < limit;
                               }));
  if (std::ssize(entries) > limit) entries.resize(static_cast<std::size_t>(limit));
  return entries;
}

Result<Job> share_job(Connection& connection, const std::string& name, bool shared) {
  v1::ShareJobRequest request;
  request.set_name(name);
  request.set_shared(shared);
  HP_ASSIGN_OR_RETURN(const v1::Job job, call(connection, *connection.impl().jobs,
                                              &v1::JobService::Stub::ShareJob, request));
  return from_proto(job);
}

}  // namespace hydroprint::client
