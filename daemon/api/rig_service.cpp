#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "daemon/api/services.h"
#include "daemon/jobs/field_check.h"
#include "daemon/platform/log.h"
#include "daemon/rig/to_proto_rig.h"
#include "daemon/rpc/caller_metadata.h"
#include "daemon/rpc/grpc_status.h"
#include "daemon/store/idempotency.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/rig_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

// Each watch occupies a thread. With the watches of JobService and EventService, the number of
// threads stays far below the limit of the server.
constexpr int kMaxRigWatches = 32;
constexpr double kDefaultRate_hz = 10;
constexpr std::chrono::seconds kQuietest{2};
constexpr milliseconds kWatchInterval{100};
constexpr double kDefaultSpeed_mm_per_s = 5;

/// StopMotion runs on separate threads (of gRPC's callback API), which other calls cannot occupy.
class RigService final
    : public v1::RigService::WithCallbackMethod_StopMotion<v1::RigService::Service> {
 public:
  explicit RigService(const ServiceContext& backend) : backend_(backend) {}

  grpc::ServerUnaryReactor* StopMotion(grpc::CallbackServerContext* context,
                                       const v1::StopMotionRequest*, v1::Rig* reply) override {
    grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
    if (backend_.gateway.controller() != nullptr) backend_.gateway.controller()->stop();
    const auto caller = caller_of(*context);
    backend_.gateway.note_stop(caller ? caller->name : "somebody");
    *reply = rig_message(backend_.gateway);
    reactor->Finish(grpc::Status::OK);
    return reactor;
  }

  grpc::Status GetRig(grpc::ServerContext*, const v1::GetRigRequest*, v1::Rig* reply) override {
    *reply = rig_message(backend_.gateway);
    return grpc::Status::OK;
  }

  grpc::Status WatchRig(grpc::ServerContext* context, const v1::WatchRigRequest* request,
                        grpc::ServerWriter<v1::Rig>* writer) override {
    const int before = watches_.fetch_add(1);
    const Status status =
        before < kMaxRigWatches
            ? watch(*context, *request, *writer)
            : fail(Code::kResourceExhausted,
                   "too many watches are open; poll the rig's state instead, or try again later",
                   ErrorReason::WATCHES_FULL);
    watches_.fetch_sub(1);
    return to_grpc(status);
  }

  grpc::Status Arm(grpc::ServerContext* context, const v1::ArmRequest* request,
                   v1::Rig* reply) override {
    return command(
        *context, *request, "rig_armed", [](auto& rig) { return rig.arm(); }, reply);
  }

  grpc::Status Disarm(grpc::ServerContext* context, const v1::DisarmRequest* request,
                      v1::Rig* reply) override {
    return command(
        *context, *request, "rig_disarmed", [](auto& rig) { return rig.disarm(); }, reply);
  }

  grpc::Status Home(grpc::ServerContext* context, const v1::HomeRequest* request,
                    v1::Rig* reply) override {
    return once(
        *context, *request, "Home",
        [&] {
          return command(
              *context, *request, "rig_homing", [](auto& rig) { return rig.home(); }, reply);
        },
        reply);
  }

  grpc::Status MoveTo(grpc::ServerContext* context, const v1::MoveToRequest* request,
                      v1::Rig* reply) override {
    return once(
        *context, *request, "MoveTo",
        [&] {
          return command(
              *context, *request, "rig_moving",
              [&](auto& rig) { return rig.move_to(request->position_mm(), speed(*request, rig)); },
              reply);
        },
        reply);
  }

  grpc::Status Jog(grpc::ServerContext* context, const v1::JogRequest* request,
                   v1::Rig* reply) override {
    return answer(jog(*context, *request), reply);
  }

  grpc::Status ResetFault(grpc::ServerContext* context, const v1::ResetFaultRequest* request,
                          v1::Rig* reply) override {
    return command(
        *context, *request, "rig_reset", [](auto& rig) { return rig.reset(); }, reply);
  }

 private:
  static double speed(const v1::MoveToRequest& request, const rig::Controller& rig) {
    if (request.has_speed_mm_per_s()) return request.speed_mm_per_s();
    return std::min(kDefaultSpeed_mm_per_s, rig.config().max_speed_mm_per_s);
  }

  grpc::Status answer(const Status& done, v1::Rig* reply) const {
    if (!done) return to_grpc(never_again(done.error()));
    *reply = rig_message(backend_.gateway);
    return grpc::Status::OK;
  }

  /// Sends a command to the rig, waits until the drive has accepted it, and logs it.
  template <class Request>
  grpc::Status command(const grpc::ServerContext& context, const Request& request,
                       const char* event, const RigGateway::Order& order, v1::Rig* reply) {
    const Status done = [&]() -> Status {
      HP_RETURN_IF_ERROR(check_serving(backend_));
      HP_ASSIGN_OR_RETURN(auto taken, backend_.gateway.order(request.lease_id(), order));
      HP_ASSIGN_OR_RETURN(const std::uint64_t motion, taken.get());
      log(LogLevel::kInfo, event,
          {{"by", owner_of(context).value_or("")}, {"motion", static_cast<std::int64_t>(motion)}});
      return {};
    }();
    return answer(done, reply);
  }

  /// Runs `action` unless a request with the same id was executed before.
  template <class Request, class Action>
  grpc::Status once(const grpc::ServerContext& context, const Request& request, const char* method,
                    const Action& action, v1::Rig* reply) {
    if (const Status good = check_fields(request); !good) return to_grpc(good);
    if (request.request_id().empty()) return action();
    const std::lock_guard lock(once_mutex_);  // the same request may arrive twice in parallel
    const RequestKey key = request_key(method, request);
    const auto owner = owner_of(context);
    if (!owner) return to_grpc(owner.error());
    const auto is_new = first_time(backend_.database, *owner, key, system_clock_ms());
    if (!is_new) return to_grpc(never_again(is_new.error()));
    if (!*is_new) return answer({}, reply);
    const grpc::Status status = action();
    if (status.ok()) return status;
    if (const Status forgotten = forget_request(backend_.database, *owner, key); !forgotten) {
      log(LogLevel::kError, "request_not_forgotten", {{"message", forgotten.error().message}});
    }
    return status;
  }

  Status jog(const grpc::ServerContext& context, const v1::JogRequest& request) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    HP_RETURN_IF_ERROR(check_fields(request));
    HP_ASSIGN_OR_RETURN(auto taken,
                        backend_.gateway.jog(request.lease_id(), request.speed_mm_per_s()));
    HP_ASSIGN_OR_RETURN(const std::uint64_t motion, taken.get());
    if (last_jog_.exchange(motion) != motion) {
      log(LogLevel::kInfo, "rig_jogging",
          {{"by", owner_of(context).value_or("")}, {"motion", static_cast<std::int64_t>(motion)}});
    }
    return {};
  }

  Status watch(const grpc::ServerContext& context, const v1::WatchRigRequest& request,
               grpc::ServerWriter<v1::Rig>& writer) {
    HP_RETURN_IF_ERROR(check_fields(request));
    const double rate_hz = request.has_max_rate_hz() ? request.max_rate_hz() : kDefaultRate_hz;
    const auto period = std::chrono::duration_cast<SteadyClock::duration>(
        std::chrono::duration<double>(1 / rate_hz));
    const auto quietest = std::max<SteadyClock::duration>(kQuietest, period);
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
    v1::Rig sent;
    SteadyClock::time_point sent_at;
    for (bool first = true;; std::this_thread::sleep_for(kWatchInterval)) {
      HP_RETURN_IF_ERROR(check_serving(backend_));
      HP_RETURN_IF_ERROR(backend_.access.check_still(caller));
      if (context.IsCancelled()) return fail(Code::kCancelled, "the client disconnected");
      const auto since = SteadyClock::now() - sent_at;
      // A sleep may end slightly early; without this tolerance the rate would be halved.
      if (!first && since < period - kWatchInterval / 10) continue;
      v1::Rig now = rig_message(backend_.gateway);
      if (!first && since < quietest && looks_same(now, sent)) continue;
      if (!writer.Write(now)) return fail(Code::kCancelled, "the client disconnected");
      first = false;
      sent_at = SteadyClock::now();
      sent = std::move(now);
    }
  }

  ServiceContext backend_;
  std::atomic<int> watches_{0};
  std::atomic<std::uint64_t> last_jog_{0};
  std::mutex once_mutex_;
};

}  // namespace

std::unique_ptr<grpc::Service> make_rig_service(const ServiceContext& backend) {
  return std::make_unique<RigService>(backend);
}

}  // namespace hydroprint::daemon
