#include <google/protobuf/util/message_differencer.h>

#include "daemon/api/services.h"
#include "daemon/api/to_proto_queue.h"
#include "daemon/auth/visibility.h"
#include "daemon/platform/cached.h"
#include "daemon/platform/resource_names.h"
#include "daemon/rig/to_proto_rig.h"
#include "daemon/rpc/caller_metadata.h"
#include "daemon/rpc/grpc_status.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/event_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

using google::protobuf::util::MessageDifferencer;
using std::chrono::milliseconds;
using EventClock = std::chrono::steady_clock;

constexpr int kMaxEventWatches = 128;  // each occupies a thread
constexpr int kEventBatch = 100;
constexpr milliseconds kRigPeriod{100};
constexpr milliseconds kRigQuietest{2000};
constexpr milliseconds kQueuePeriod{500};
constexpr milliseconds kEventPollInterval{250};

struct Topics {
  bool job = false, rig = false, queue = false, lease = false;
};

Result<Topics> topics_of(const v1::WatchEventsRequest& request) {
  if (request.topics().empty()) return Topics{true, true, true, true};
  Topics topics;
  for (const std::string& name : request.topics()) {
    bool* const topic = name == "job"     ? &topics.job
                        : name == "rig"   ? &topics.rig
                        : name == "queue" ? &topics.queue
                        : name == "lease" ? &topics.lease
                                          : nullptr;
    if (topic == nullptr) return invalid_field("topics", "must be job, rig, queue or lease");
    *topic = true;
  }
  return topics;
}

/// State shared by all watches.
struct Shared {
  Cached<v1::Rig> rig;
  Cached<v1::Queue> queue;
};

/// One watch, running in the thread of its call.
class EventWatch {
 public:
  EventWatch(const ServiceContext& backend, Shared& shared, const Topics& topics,
             auth::Caller caller, grpc::ServerWriter<v1::WatchEventsResponse>& writer)
      : backend_(backend),
        shared_(shared),
        topics_(topics),
        caller_(std::move(caller)),
        writer_(writer) {}

  Status run(const grpc::ServerContext& context, std::optional<std::int64_t> after_seq) {
    HP_ASSIGN_OR_RETURN(seq_, backend_.jobs.last_seq());
    if (after_seq) {
      HP_RETURN_IF_ERROR(backend_.jobs.all_events(*after_seq, 1));
      seq_ = *after_seq;
    }
    v1::WatchEventsResponse first;
    first.set_seq(seq_);
    HP_RETURN_IF_ERROR(send(first));
    for (;;) {
      const std::uint64_t version = backend_.jobs.notifier().count();
      HP_ASSIGN_OR_RETURN(const bool is_all, send_jobs());
      HP_RETURN_IF_ERROR(send_rig());
      HP_RETURN_IF_ERROR(send_lease());
      HP_RETURN_IF_ERROR(send_queue());
      HP_RETURN_IF_ERROR(check_serving(backend_));
      HP_RETURN_IF_ERROR(backend_.access.check_still(caller_));
      if (context.IsCancelled()) return fail(Code::kCancelled, "the client disconnected");
      if (is_all)
        backend_.jobs.notifier().wait(version, topics_.rig ? kRigPeriod : kEventPollInterval);
    }
  }

 private:
  Status send(const v1::WatchEventsResponse& message) {
    if (writer_.Write(message)) return {};
    return fail(Code::kCancelled, "the client disconnected");
  }

  // Sends one batch of job events. Returns whether no more events are pending.
  Result<bool> send_jobs() {
    if (!topics_.job) return true;
    HP_ASSIGN_OR_RETURN(const auto events, backend_.jobs.all_events(seq_, kEventBatch));
    for (const JobEvent& event : events) {
      v1::WatchEventsResponse message;
      message.set_seq(event.seq);
      *message.mutable_job()->mutable_event() = to_message(event);
      if (event.kind == EventKind::kStateChanged) {
        const auto job = backend_.jobs.get(event.job);
        if (job) *message.mutable_job()->mutable_job() = shown_to(caller_, *job);
      }
      HP_RETURN_IF_ERROR(send(message));
      seq_ = event.seq;
    }
    return events.size() < kEventBatch;
  }

  Status send_rig() {
    if (!topics_.rig) return {};
    const auto since = EventClock::now() - rig_sent_;
    // A wait may end slightly early; without this tolerance the rate would be halved.
    if (since < kRigPeriod - kRigPeriod / 10) return {};
    const auto rig = shared_.rig.get();
    if (since < kRigQuietest && looks_same(*rig, rig_)) return {};
    rig_ = *rig;
    rig_sent_ = EventClock::now();
    v1::WatchEventsResponse message;
    *message.mutable_rig() = *rig;
    return send(message);
  }

  Status send_lease() {
    if (!topics_.lease) return {};
    v1::LeaseNews news;
    if (const auto lease = backend_.gateway.leases().current()) {
      *news.mutable_lease() = to_message(*lease, false);
    }
    if (lease_ && MessageDifferencer::Equals(*lease_, news)) return {};
    lease_ = news;
    v1::WatchEventsResponse message;
    *message.mutable_lease() = std::move(news);
    return send(message);
  }

  Status send_queue() {
    if (!topics_.queue) return {};
    const auto queue = shared_.queue.get();
    if (queue == queue_ || (queue_ && MessageDifferencer::Equals(*queue, *queue_))) return {};
    queue_ = queue;
    v1::WatchEventsResponse message;
    *message.mutable_queue() = *queue;
    return send(message);
  }

  const ServiceContext& backend_;
  Shared& shared_;
  Topics topics_;
  auth::Caller caller_;
  grpc::ServerWriter<v1::WatchEventsResponse>& writer_;
  std::int64_t seq_ = 0;
  v1::Rig rig_;
  EventClock::time_point rig_sent_{};
  std::optional<v1::LeaseNews> lease_;
  std::shared_ptr<const v1::Queue> queue_;
};

class EventService final : public v1::EventService::Service {
 public:
  explicit EventService(const ServiceContext& backend) : backend_(backend) {}

  grpc::Status WatchEvents(grpc::ServerContext* context, const v1::WatchEventsRequest* request,
                           grpc::ServerWriter<v1::WatchEventsResponse>* writer) override {
    const int before = watches_.fetch_add(1);
    const Status status =
        before < kMaxEventWatches
            ? watch(*context, *request, *writer)
            : fail(Code::kResourceExhausted, "too many watches are open; try again later",
                   ErrorReason::WATCHES_FULL);
    watches_.fetch_sub(1);
    return to_grpc(status);
  }

 private:
  Status watch(const grpc::ServerContext& context, const v1::WatchEventsRequest& request,
               grpc::ServerWriter<v1::WatchEventsResponse>& writer) {
    HP_ASSIGN_OR_RETURN(const Topics topics, topics_of(request));
    HP_ASSIGN_OR_RETURN(auth::Caller caller, caller_of(context));
    const auto after = request.has_after_seq() ? std::optional(request.after_seq()) : std::nullopt;
    return EventWatch(backend_, shared_, topics, std::move(caller), writer).run(context, after);
  }

  ServiceContext backend_;
  Shared shared_{{[this] { return rig_message(backend_.gateway); }, kRigPeriod / 2},
                 {[this] { return queue_message(backend_).value_or(v1::Queue()); }, kQueuePeriod}};
  std::atomic<int> watches_{0};
};

}  // namespace

std::unique_ptr<grpc::Service> make_event_service(const ServiceContext& backend) {
  return std::make_unique<EventService>(backend);
}

}  // namespace hydroprint::daemon
