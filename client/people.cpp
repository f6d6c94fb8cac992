#include "client/people.h"

#include "client/connection/rpc.h"

namespace hydroprint::client {
namespace {

using PeopleStub = v1::PeopleService::Stub;

PeopleStub& people(Connection& connection) { return *connection.impl().people; }

// Calls of call_once() need the prefix client::, because argument-dependent lookup also finds
// protobuf's function of that name.

// Sends a request that holds only a name and expects an empty response.
template <class Request>
Status by_name(Connection& connection, const std::string& name,
               grpc::Status (PeopleStub::*method)(grpc::ClientContext*, const Request&,
                                                  google::protobuf::Empty*)) {
  HP_RETURN_IF_ERROR(
      client::call_once(connection, people(connection), method, named<Request>(name)));
  return {};
}

Result<std::string> begin_session(Connection& connection, const v1::SignInRequest& request) {
  HP_RETURN_IF_ERROR(check_secrets_may_go(connection.options()));
  HP_ASSIGN_OR_RETURN(
      const v1::SignInResponse reply,
      client::call_once(connection, people(connection), &PeopleStub::SignIn, request));
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
  HP_RETURN_IF_ERROR(client::call_once(connection, people(connection), &PeopleStub::SignOut,
                                       v1::SignOutRequest()));
  return {};
}

Result<v1::WhoAmIResponse> who_am_i(Connection& connection) {
  return call(connection, people(connection), &PeopleStub::WhoAmI, v1::WhoAmIRequest());
}

Result<v1::Usage> get_usage(Connection& connection) {
  return call(connection, people(connection), &PeopleStub::GetUsage, v1::GetUsageRequest());
}

Result<v1::ListUsersResponse> list_users(Connection& connection) {
  return all_pages(connection, people(connection), &PeopleStub::ListUsers, v1::ListUsersRequest(),
                   &v1::ListUsersResponse::users_size);
}

Result<v1::User> create_user(Connection& connection, const v1::CreateUserRequest& request) {
  HP_RETURN_IF_ERROR(check_secrets_may_go(connection.options()));
  return client::call_once(connection, people(connection), &PeopleStub::CreateUser, request);
}

Result<v1::User> update_user(Connection& connection, const v1::UpdateUserRequest& request) {
  return call(connection, people(connection), &PeopleStub::UpdateUser, request);
}

Result<v1::User> set_password(Connection& connection, const v1::SetPasswordRequest& request) {
  HP_RETURN_IF_ERROR(check_secrets_may_go(connection.options()));
  return client::call_once(connection, people(connection), &PeopleStub::SetPassword, request);
}

Result<v1::SignInLink> create_sign_in_link(Connection& connection, const std::string& name) {
  return client::call_once(connection, people(connection), &PeopleStub::CreateSignInLink,
                           named<v1::CreateSignInLinkRequest>(name));
}

Status delete_user(Connection& connection, const std::string& name) {
  return by_name(connection, name, &PeopleStub::DeleteUser);
}

Result<v1::ListApiKeysResponse> list_api_keys(Connection& connection) {
  return all_pages(connection, people(connection), &PeopleStub::ListApiKeys,
                   v1::ListApiKeysRequest(), &v1::ListApiKeysResponse::api_keys_size);
}

Result<v1::CreateApiKeyResponse> create_api_key(Connection& connection,
                                                const v1::CreateApiKeyRequest& request) {
  return client::call_once(connection, people(connection), &PeopleStub::CreateApiKey, request);
}

Status delete_api_key(Connection& connection, const std::string& name) {
  return by_name(connection, name, &PeopleStub::DeleteApiKey);
}

Result<v1::ListSessionsResponse> list_sessions(Connection& connection) {
  return all_pages(connection, people(connection), &PeopleStub::ListSessions,
                   v1::ListSessionsRequest(), &v1::ListSessionsResponse::sessions_size);
}

Status revoke_session(Connection& connection, const std::string& name) {
  return by_name(connection, name, &PeopleStub::RevokeSession);
}

Result<v1::ListAuditResponse> list_audit(Connection& connection, const std::string& who,
                                         const std::string& what, int limit) {
  v1::ListAuditRequest request;
  request.set_who(who);
  request.set_what(what);
  return all_pages(connection, people(connection), &PeopleStub::ListAudit, request,
                   &v1::ListAuditResponse::entries_size, limit);
}

Result<v1::Job> share_job(Connection& connection, const std::string& name, bool shared) {
  auto request = named<v1::ShareJobRequest>(name);
  request.set_shared(shared);
  return call(connection, *connection.impl().jobs, &v1::JobService::Stub::ShareJob, request);
}

}  // namespace hydroprint::client
