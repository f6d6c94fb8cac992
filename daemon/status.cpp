#include "daemon/status.h"

#include "daemon/names.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace hydroprint::daemon {
namespace {

// Where the reason is not given, the code's name is one.
const char* default_reason(Code code) {
  switch (code) {
    case Code::kCancelled:
      return "CANCELLED";
    case Code::kInvalidArgument:
      return "SPEC_INVALID";
    case Code::kResourceExhausted:
      return "DISK_FULL";
    case Code::kFailedPrecondition:
      return "STATE_FORBIDS";
    default:
      return "STORE_FAILED";
  }
}

// Seconds after which trying again may help; 0: it does not.
std::int64_t retry_after_s(const Error& error) {
  for (const char* const full : {"QUEUE_FULL", "UPLOADS_FULL", "PREVIEWS_FULL"}) {
    if (error.reason == full) return 10;
  }
  const auto told = error.metadata.find("retry_s");
  return told == error.metadata.end() ? 0 : parse_number(told->second);
}

}  // namespace

int number_of(Code code) {
  switch (code) {
    case Code::kCancelled:
      return grpc::StatusCode::CANCELLED;
    case Code::kInvalidArgument:
      return grpc::StatusCode::INVALID_ARGUMENT;
    case Code::kNotFound:
      return grpc::StatusCode::NOT_FOUND;
    case Code::kAlreadyExists:
      return grpc::StatusCode::ALREADY_EXISTS;
    case Code::kPermissionDenied:
      return grpc::StatusCode::PERMISSION_DENIED;
    case Code::kResourceExhausted:
      return grpc::StatusCode::RESOURCE_EXHAUSTED;
    case Code::kFailedPrecondition:
      return grpc::StatusCode::FAILED_PRECONDITION;
    case Code::kAborted:
      return grpc::StatusCode::ABORTED;
    case Code::kOutOfRange:
      return grpc::StatusCode::OUT_OF_RANGE;
    case Code::kUnimplemented:
      return grpc::StatusCode::UNIMPLEMENTED;
    case Code::kInternal:
      return grpc::StatusCode::INTERNAL;
    case Code::kUnavailable:
      return grpc::StatusCode::UNAVAILABLE;
    case Code::kDataLoss:
      return grpc::StatusCode::DATA_LOSS;
    case Code::kUnauthenticated:
      return grpc::StatusCode::UNAUTHENTICATED;
  }
  return grpc::StatusCode::INTERNAL;
}

grpc::Status to_grpc(const Error& error) {
  google::rpc::Status details;
  details.set_code(number_of(error.code));
  details.set_message(error.message);
  google::rpc::ErrorInfo info;
  info.set_domain("hydroprint");
  info.set_reason(error.reason.empty() ? default_reason(error.code) : error.reason);
  info.mutable_metadata()->insert(error.metadata.begin(), error.metadata.end());
  details.add_details()->PackFrom(info);
  if (const std::int64_t seconds = retry_after_s(error); seconds > 0) {
    google::rpc::RetryInfo retry;
    retry.mutable_retry_delay()->set_seconds(seconds);
    details.add_details()->PackFrom(retry);
  }
  return {static_cast<grpc::StatusCode>(number_of(error.code)), error.message,
          details.SerializeAsString()};
}

grpc::Status to_grpc(const Status& status) {
  return status ? grpc::Status::OK : to_grpc(status.error());
}

}  // namespace hydroprint::daemon
