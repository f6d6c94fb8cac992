#include "daemon/api/audit_interceptor.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <map>
#include <mutex>

#include "daemon/platform/clock.h"
#include "daemon/rpc/caller_metadata.h"
#include "daemon/rpc/grpc_status.h"
#include "google/api/annotations.pb.h"
#include "hydroprint/v1/access.pb.h"
#include "sim/base/utf8.h"

namespace hydroprint::daemon {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using grpc::experimental::InterceptionHookPoints;
using grpc::experimental::InterceptorBatchMethods;
using grpc::experimental::ServerRpcInfo;

constexpr std::int64_t kRecordInterval_ms = 60'000;
constexpr std::chrono::milliseconds kWritten_ms{2000};
constexpr std::size_t kLongestDetail = 300;
constexpr const char* kPreviews = "hydroprint.v1.PreviewService.";  // they change nothing

// Shortens "/hydroprint.v1.RigService/MoveTo" to "RigService.MoveTo".
std::string short_name(const std::string& method) {
  const auto slash = method.rfind('/');
  const auto dot = method.rfind('.', slash);
  return method.substr(dot + 1, slash - dot - 1) + "." + method.substr(slash + 1);
}

std::string text_field(const Message& message, const char* name) {
  const auto* const field = message.GetDescriptor()->FindFieldByName(name);
  if (field == nullptr || field->is_repeated() || field->type() != FieldDescriptor::TYPE_STRING) {
    return {};
  }
  return one_line(message.GetReflection()->GetString(message, field).substr(0, kLongestDetail));
}

// Returns the name of the resource that a message concerns: "jobs/7"; empty if it has none.
std::string object_of(const Message& message) {
  for (const char* const name : {"name", "parent"}) {
    if (std::string text = text_field(message, name); !text.empty()) return text;
  }
  const auto* const user = message.GetDescriptor()->FindFieldByName("user");
  if (user == nullptr || user->type() != FieldDescriptor::TYPE_MESSAGE) return {};
  const std::string name = text_field(message.GetReflection()->GetMessage(message, user), "name");
  return name.starts_with("users/") || name.empty() ? name : "users/" + name;
}

std::string plain_text(const Message& message, const FieldDescriptor& field) {
  const auto& reflection = *message.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return fmt::format("{:g}", reflection.GetDouble(message, &field));
    case FieldDescriptor::CPPTYPE_BOOL:
      return reflection.GetBool(message, &field) ? "true" : "false";
    case FieldDescriptor::CPPTYPE_ENUM:
      return reflection.GetEnum(message, &field)->name();
    default:
      return {};
  }
}

// Returns the reason in a request and its fields of type double, bool and enum. Other text is
// omitted, because it may be secret.
std::string detail_of(const Message& message) {
  std::string out = text_field(message, "reason");
  std::vector<const FieldDescriptor*> set;
  message.GetReflection()->ListFields(message, &set);
  for (const FieldDescriptor* const field : set) {
    if (field->is_repeated()) continue;
    const std::string text = plain_text(message, *field);
    if (!text.empty()) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", field->name(), text);
  }
  return out;
}

std::string outcome_of(const grpc::Status& status) {
  switch (status.error_code()) {
    case grpc::StatusCode::OK:
      return "OK";
    case grpc::StatusCode::UNKNOWN:
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      return "UNKNOWN";
    default:
      break;
  }
  for (int code = 0; code <= static_cast<int>(Code::kUnauthenticated); ++code) {
    if (number_of(static_cast<Code>(code)) == status.error_code()) {
      return std::string(code_name(static_cast<Code>(code)));
    }
  }
  return "UNKNOWN";
}

/// Decides whether a frequent call is recorded: at most once per kRecordInterval_ms for each key.
class RateLimit {
 public:
  bool is_due(const std::string& key) {
    const std::lock_guard lock(mutex_);
    const std::int64_t now_ms = system_clock_ms();
    std::erase_if(last_recorded_,
                  [&](const auto& entry) { return now_ms - entry.second > kRecordInterval_ms; });
    return last_recorded_.emplace(key, now_ms).second;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::int64_t> last_recorded_;
};

// Returns whether clients repeat calls of a method as long as an action continues.
bool is_frequent(const std::string& what) {
  return what == "RigService.Jog" || what == "LeaseService.RenewLease";
}

/// Records calls; frequent calls at most once a minute for each caller, method and outcome.
class Recorder {
 public:
  explicit Recorder(auth::AuditLog& audit) : audit_(audit) {}

  void record(const auth::AuditEntry& entry) { static_cast<void>(note(entry)); }
  /// Records a call and waits until the entry is on disk, except for calls that stop the rig or
  /// keep it in motion.
  void record_on_disk(const auth::AuditEntry& entry) {
    const std::uint64_t noted = note(entry);
    if (is_frequent(entry.what) || entry.what == "RigService.StopMotion") return;
    audit_.wait_written(noted, kWritten_ms);
  }

 private:
  std::uint64_t note(const auth::AuditEntry& entry) {
    const std::string key = entry.who + " " + entry.what + entry.outcome;
    return is_frequent(entry.what) && !rate_limit_.is_due(key) ? 0 : audit_.note(entry);
  }

  auth::AuditLog& audit_;
  RateLimit rate_limit_;
};

class AuditInterceptor final : public grpc::experimental::Interceptor {
 public:
  AuditInterceptor(ServerRpcInfo& call, Recorder& recorder) : call_(call), recorder_(recorder) {}

  void Intercept(InterceptorBatchMethods* step) override {
    if (step->QueryInterceptionHookPoint(InterceptionHookPoints::POST_RECV_INITIAL_METADATA)) {
      see_caller();
    }
    if (step->QueryInterceptionHookPoint(InterceptionHookPoints::POST_RECV_MESSAGE)) {
      see_request(static_cast<const Message*>(step->GetRecvMessage()));
    }
    if (step->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_MESSAGE)) {
      see_reply(static_cast<const Message*>(step->GetSendMessage()));
    }
    if (step->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS)) {
      record_status(step->GetSendStatus());
    }
    step->Proceed();
  }

 private:
  void see_caller() {
    const auto caller = caller_of(*call_.server_context());
    if (!caller) return;
    entry_.who = caller->name;
    entry_.via = caller->via;
    entry_.peer = caller->credentials.peer;
  }
  void see_request(const Message* request) {
    if (request == nullptr) return;
    entry_.object = object_of(*request);
    entry_.detail = detail_of(*request);
  }
  // The name of a created resource is known only from the response.
  void see_reply(const Message* reply) {
    if (reply != nullptr && entry_.object.empty()) entry_.object = object_of(*reply);
  }
  void record_status(const grpc::Status& status) {
    if (entry_.who.empty()) return;
    entry_.what = short_name(call_.method());
    entry_.outcome = outcome_of(status);
    if (!status.ok()) entry_.detail = one_line(status.error_message());
    entry_.detail = entry_.detail.substr(0, kLongestDetail);
    recorder_.record_on_disk(entry_);
  }

  ServerRpcInfo& call_;
  Recorder& recorder_;
  auth::AuditEntry entry_;
};

// Returns whether calls of a method ("/hydroprint.v1.RigService/MoveTo") are recorded.
bool is_noted(std::string method) {
  if (method.empty()) return false;
  method.erase(0, 1);
  std::replace(method.begin(), method.end(), '/', '.');
  const auto* const found =
      google::protobuf::DescriptorPool::generated_pool()->FindMethodByName(method);
  if (found == nullptr || found->client_streaming() || found->server_streaming() ||
      method.starts_with(kPreviews))
    return false;
  const auto& options = found->options();
  return options.HasExtension(v1::role) && !options.GetExtension(google::api::http).has_get();
}

class AuditInterceptorFactory final : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  explicit AuditInterceptorFactory(auth::AuditLog& audit) : recorder_(audit) {}

  grpc::experimental::Interceptor* CreateServerInterceptor(ServerRpcInfo* call) override {
    return is_noted(call->method()) ? new AuditInterceptor(*call, recorder_)
                                    : nullptr;  // gRPC takes ownership
  }

 private:
  Recorder recorder_;
};

}  // namespace

std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> make_audit_interceptor(
    auth::AuditLog& audit) {
  return std::make_unique<AuditInterceptorFactory>(audit);
}

OnRefusal make_refusal_recorder(auth::AuditLog& audit) {
  return [recorder = std::make_shared<Recorder>(audit)](
             const auth::Caller& caller, std::string_view method, const Error& error) {
    const std::string name(method);
    if (!is_noted(name)) return;
    auth::AuditEntry entry;
    entry.who = caller.name;
    entry.via = caller.via;
    entry.peer = caller.credentials.peer;
    entry.what = short_name(name);
    entry.outcome = std::string(code_name(error.code));
    entry.detail = one_line(error.message).substr(0, kLongestDetail);
    recorder->record(entry);
  };
}

}  // namespace hydroprint::daemon
