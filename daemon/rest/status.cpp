#include "daemon/rest/status.h"

#include <cstdlib>

#include "daemon/rest/bad_request.h"
#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace hydroprint::rest {
namespace {

// Returns the reason to report for errors that state none.
ErrorReason default_reason(Code code) {
  switch (code) {
    case Code::kCancelled:
      return ErrorReason::CANCELLED;
    case Code::kInvalidArgument:
      return ErrorReason::SPEC_INVALID;
    case Code::kResourceExhausted:
      return ErrorReason::DISK_FULL;
    case Code::kFailedPrecondition:
      return ErrorReason::STATE_FORBIDS;
    default:
      return ErrorReason::STORE_FAILED;
  }
}

// Returns the time after which to retry, s; 0 if a retry does not help.
int retry_after_s(const Error& error) {
  for (const ErrorReason full :
       {ErrorReason::QUEUE_FULL, ErrorReason::UPLOADS_FULL, ErrorReason::PREVIEWS_FULL}) {
    if (error.reason == full) return 10;
  }
  const auto retry_s = error.metadata.find("retry_s");
  return retry_s == error.metadata.end() ? 0 : std::atoi(retry_s->second.c_str());
}

}  // namespace

int number_of(Code code) {
  switch (code) {
    case Code::kCancelled:
      return google::rpc::CANCELLED;
    case Code::kInvalidArgument:
      return google::rpc::INVALID_ARGUMENT;
    case Code::kNotFound:
      return google::rpc::NOT_FOUND;
    case Code::kAlreadyExists:
      return google::rpc::ALREADY_EXISTS;
    case Code::kPermissionDenied:
      return google::rpc::PERMISSION_DENIED;
    case Code::kResourceExhausted:
      return google::rpc::RESOURCE_EXHAUSTED;
    case Code::kFailedPrecondition:
      return google::rpc::FAILED_PRECONDITION;
    case Code::kAborted:
      return google::rpc::ABORTED;
    case Code::kOutOfRange:
      return google::rpc::OUT_OF_RANGE;
    case Code::kUnimplemented:
      return google::rpc::UNIMPLEMENTED;
    case Code::kInternal:
      return google::rpc::INTERNAL;
    case Code::kUnavailable:
      return google::rpc::UNAVAILABLE;
    case Code::kDataLoss:
      return google::rpc::DATA_LOSS;
    case Code::kUnauthenticated:
      return google::rpc::UNAUTHENTICATED;
  }
  return google::rpc::INTERNAL;
}

std::string status_details(const Error& error) {
  google::rpc::Status details;
  details.set_code(number_of(error.code));
  details.set_message(full_message(error));
  google::rpc::ErrorInfo info;
  info.set_domain("hydroprint");
  const bool has_reason = error.reason != ErrorReason{};
  info.set_reason(std::string(name_of(has_reason ? error.reason : default_reason(error.code))));
  const auto metadata = shown_metadata(error);
  info.mutable_metadata()->insert(metadata.begin(), metadata.end());
  details.add_details()->PackFrom(info);
  if (const auto violations = violations_of(error); !violations.empty()) {
    google::rpc::BadRequest request;
    for (const rules::Violation& violation : violations) {
      auto& shown = *request.add_field_violations();
      shown.set_field(violation.field);
      shown.set_description(violation.problem);
    }
    details.add_details()->PackFrom(request);
  }
  if (const int seconds = retry_after_s(error); seconds > 0) {
    google::rpc::RetryInfo retry;
    retry.mutable_retry_delay()->set_seconds(seconds);
    details.add_details()->PackFrom(retry);
  }
  return details.SerializeAsString();
}

}  // namespace hydroprint::rest
