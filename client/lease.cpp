#include "client/lease.h"

#include "client/connection/rpc.h"
#include "client/uuid.h"

namespace hydroprint::client {
namespace {

using LeaseStub = v1::LeaseService::Stub;

// Sends a request that may be repeated: acquiring carries a request_id, and the other requests have
// the same effect when sent twice.
template <class Request, class Response>
Result<Response> ask(Connection& connection,
                     grpc::Status (LeaseStub::*method)(grpc::ClientContext*, const Request&,
                                                       Response*),
                     const Request& request) {
  return call(connection, *connection.impl().leases, method, request);
}

}  // namespace

Result<v1::Lease> get_lease(Connection& connection) {
  return ask(connection, &LeaseStub::GetLease, v1::GetLeaseRequest());
}

Result<v1::Lease> acquire_lease(Connection& connection, const std::string& purpose,
                                std::chrono::seconds ttl) {
  v1::AcquireLeaseRequest request;
  request.set_purpose(purpose);
  request.mutable_ttl()->set_seconds(ttl.count());
  request.set_request_id(make_uuid());
  return ask(connection, &LeaseStub::AcquireLease, request);
}

Result<v1::Lease> renew_lease(Connection& connection, const std::string& lease_id,
                              std::chrono::seconds ttl) {
  v1::RenewLeaseRequest request;
  request.set_lease_id(lease_id);
  request.mutable_ttl()->set_seconds(ttl.count());
  return ask(connection, &LeaseStub::RenewLease, request);
}

Status release_lease(Connection& connection, const std::string& lease_id) {
  v1::ReleaseLeaseRequest request;
  request.set_lease_id(lease_id);
  HP_RETURN_IF_ERROR(ask(connection, &LeaseStub::ReleaseLease, request));
  return {};
}

Status break_lease(Connection& connection, const std::string& reason) {
  v1::BreakLeaseRequest request;
  request.set_reason(reason);
  HP_RETURN_IF_ERROR(ask(connection, &LeaseStub::BreakLease, request));
  return {};
}

}  // namespace hydroprint::client
