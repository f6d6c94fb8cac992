#include "sim/base/result.h"

namespace hydroprint {

std::string_view code_name(Code code) {
  switch (code) {
    case Code::kCancelled:
      return "CANCELLED";
    case Code::kInvalidArgument:
      return "INVALID_ARGUMENT";
    case Code::kNotFound:
      return "NOT_FOUND";
    case Code::kAlreadyExists:
      return "ALREADY_EXISTS";
    case Code::kPermissionDenied:
      return "PERMISSION_DENIED";
    case Code::kResourceExhausted:
      return "RESOURCE_EXHAUSTED";
    case Code::kFailedPrecondition:
      return "FAILED_PRECONDITION";
    case Code::kAborted:
      return "ABORTED";
    case Code::kOutOfRange:
      return "OUT_OF_RANGE";
    case Code::kUnimplemented:
      return "UNIMPLEMENTED";
    case Code::kInternal:
      return "INTERNAL";
    case Code::kUnavailable:
      return "UNAVAILABLE";
    case Code::kDataLoss:
      return "DATA_LOSS";
    case Code::kUnauthenticated:
      return "UNAUTHENTICATED";
  }
  return "INTERNAL";
}

ExitStatus exit_status(const Error& error) {
  // Other lack of resources, such as a full disk, counts as bad input.
  if (error.reason == "OUT_OF_MEMORY") return ExitStatus::kFailed;
  switch (error.code) {
    case Code::kCancelled:
      return ExitStatus::kCancelled;
    case Code::kUnimplemented:
      return ExitStatus::kUsage;
    case Code::kInternal:
    case Code::kUnavailable:
    case Code::kAborted:
      return ExitStatus::kFailed;
    default:
      return ExitStatus::kBadInput;
  }
}

}  // namespace hydroprint
