#include <google/protobuf/util/time_util.h>

#include "daemon/convert.h"
#include "daemon/log.h"
#include "daemon/names.h"
#include "daemon/rig_convert.h"
#include "daemon/services.h"
#include "daemon/status.h"
#include "hydroprint/v1/lease_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr std::int64_t kDefaultTtlMs = 10LL * 60 * 1000;
constexpr std::int64_t kShortestTtlMs = 1000;
constexpr std::int64_t kLongestTtlMs = 8LL * 3600 * 1000;
constexpr std::size_t kLongestText = 200;

Status check_words(const char* field, const std::string& text) {
  if (text.empty()) return invalid_field(field, "is missing; say it in a few words");
  return check_text(field, text, kLongestText);
}

template <class Request>
Result<std::int64_t> ttl_of(const Request& request) {
  if (!request.has_ttl()) return kDefaultTtlMs;
  const auto& ttl = request.ttl();
  // Seconds first: the number of milliseconds might not fit.
  const bool fits = ttl.seconds() >= 0 && ttl.seconds() <= kLongestTtlMs / 1000 &&
                    ttl.nanos() >= 0 && ttl.nanos() < 1'000'000'000;
  const std::int64_t ms = fits ? ttl.seconds() * 1000 + ttl.nanos() / 1'000'000 : 0;
  if (ms < kShortestTtlMs || ms > kLongestTtlMs) {
    return invalid_field("ttl", "must be from 1 second to 8 hours");
  }
  return ms;
}

class LeaseService final : public v1::LeaseService::Service {
 public:
  explicit LeaseService(const Backend& backend) : backend_(backend) {}

  grpc::Status GetLease(grpc::ServerContext*, const v1::GetLeaseRequest*,
                        v1::Lease* reply) override {
    const auto lease = leases().current();
    if (!lease) {
      return to_grpc(
          Error{Code::kNotFound, "nobody has the rig; acquire it", "LEASE_NOT_FOUND", {}});
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
      backend_.desk.end_jog();
      log(LogLevel::kInfo, "lease_released", {{"holder", (*ended)->holder}});
    }
    return grpc::Status::OK;
  }

  grpc::Status BreakLease(grpc::ServerContext* context, const v1::BreakLeaseRequest* request,
                          google::protobuf::Empty*) override {
    return to_grpc(take_away(*context, *request));
  }

 private:
  [[nodiscard]] LeaseKeeper& leases() const { return backend_.desk.leases(); }

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
    HP_RETURN_IF_ERROR(check_words("purpose", request.purpose()));
    HP_RETURN_IF_ERROR(check_text("request_id", request.request_id(), 100));
    HP_ASSIGN_OR_RETURN(const std::int64_t ttl_ms, ttl_of(request));
    HP_ASSIGN_OR_RETURN(const std::string holder, owner_of(backend_, context));
    return leases().acquire(holder, request.purpose(), ttl_ms,
                            request_key("AcquireLease", request));
  }

  Result<Lease> renew(const v1::RenewLeaseRequest& request) {
    HP_ASSIGN_OR_RETURN(const std::int64_t ttl_ms, ttl_of(request));
    return leases().renew(request.lease_id(), ttl_ms);
  }

  Status take_away(const grpc::ServerContext& context, const v1::BreakLeaseRequest& request) {
    HP_RETURN_IF_ERROR(check_words("reason", request.reason()));
    HP_ASSIGN_OR_RETURN(const std::string breaker, owner_of(backend_, context));
    HP_ASSIGN_OR_RETURN(const auto ended, leases().take_away());
    if (!ended) return {};
    backend_.desk.end_jog();
    log(LogLevel::kWarning, "lease_broken",
        {{"by", breaker},
         {"holder", ended->holder},
         {"purpose", ended->purpose},
         {"reason", request.reason()}});
    return {};
  }

  Backend backend_;
};

}  // namespace

std::unique_ptr<grpc::Service> make_lease_service(const Backend& backend) {
  return std::make_unique<LeaseService>(backend);
}

}  // namespace hydroprint::daemon
