#include <google/protobuf/util/time_util.h>

#include "daemon/api/services.h"
#include "daemon/jobs/field_check.h"
#include "daemon/platform/log.h"
#include "daemon/rig/to_proto_rig.h"
#include "daemon/rpc/grpc_status.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/lease_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr std::int64_t kDefaultTtlMs = 10LL * 60 * 1000;

template <class Request>
std::int64_t ttl_ms_of(const Request& checked) {
  if (!checked.has_ttl()) return kDefaultTtlMs;
  return google::protobuf::util::TimeUtil::DurationToMilliseconds(checked.ttl());
}

class LeaseService final : public v1::LeaseService::Service {
 public:
  explicit LeaseService(const ServiceContext& backend) : backend_(backend) {}

  grpc::Status GetLease(grpc::ServerContext*, const v1::GetLeaseRequest*,
                        v1::Lease* reply) override {
    const auto lease = leases().current();
    if (!lease) {
      return to_grpc(Error{Code::kNotFound,
                           "nobody holds the rig's lease; acquire it",
                           ErrorReason::LEASE_NOT_FOUND,
                           {}});
    }
    *reply = to_message(*lease, false);
    return grpc::Status::OK;
  }

  grpc::Status AcquireLease(grpc::ServerContext* context, const v1::AcquireLeaseRequest* request,
                            v1::Lease* reply) override {
    return answer(acquire(*context, *request), "lease_acquired", reply);
  }

  grpc::Status RenewLease(grpc::ServerContext*, const v1::RenewLeaseRequest* request,
                          v1::Lease* reply) override {
    return answer(renew(*request), "lease_renewed", reply);
  }

  grpc::Status ReleaseLease(grpc::ServerContext*, const v1::ReleaseLeaseRequest* request,
                            google::protobuf::Empty*) override {
    const auto ended = leases().release(request->lease_id());
    if (!ended) return to_grpc(ended.error());
    if (*ended) {
      backend_.gateway.end_jog();
      log(LogLevel::kInfo, "lease_released", {{"holder", (*ended)->holder}});
    }
    return grpc::Status::OK;
  }

  grpc::Status BreakLease(grpc::ServerContext* context, const v1::BreakLeaseRequest* request,
                          google::protobuf::Empty*) override {
    return to_grpc(take_away(*context, *request));
  }

 private:
  [[nodiscard]] LeaseManager& leases() const { return backend_.gateway.leases(); }

  static grpc::Status answer(const Result<Lease>& lease, const char* event, v1::Lease* reply) {
    if (!lease) return to_grpc(lease.error());
    *reply = to_message(*lease, true);
    log(LogLevel::kInfo, event,
        {{"holder", lease->holder},
         {"purpose", lease->purpose},
         {"seconds", (lease->expire_ms - system_clock_ms()) / 1000}});
    return grpc::Status::OK;
  }

  Result<Lease> acquire(const grpc::ServerContext& context,
                        const v1::AcquireLeaseRequest& request) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    HP_RETURN_IF_ERROR(check_fields(request));
    HP_ASSIGN_OR_RETURN(const std::string holder, owner_of(context));
    return leases().acquire(holder, request.purpose(), ttl_ms_of(request),
                            request_key("AcquireLease", request));
  }

  Result<Lease> renew(const v1::RenewLeaseRequest& request) {
    HP_RETURN_IF_ERROR(check_fields(request));
    return leases().renew(request.lease_id(), ttl_ms_of(request));
  }

  Status take_away(const grpc::ServerContext& context, const v1::BreakLeaseRequest& request) {
    HP_RETURN_IF_ERROR(check_fields(request));
    HP_ASSIGN_OR_RETURN(const std::string breaker, owner_of(context));
    HP_ASSIGN_OR_RETURN(const auto ended, leases().take_away());
    if (!ended) return {};
    backend_.gateway.end_jog();
    log(LogLevel::kWarning, "lease_broken",
        {{"by", breaker},
         {"holder", ended->holder},
         {"purpose", ended->purpose},
         {"reason", request.reason()}});
    return {};
  }

  ServiceContext backend_;
};

}  // namespace

std::unique_ptr<grpc::Service> make_lease_service(const ServiceContext& backend) {
  return std::make_unique<LeaseService>(backend);
}

}  // namespace hydroprint::daemon
