#include "sim/base/result.h"

namespace hydroprint {

ExitStatus exit_status(const Error& error) {
  if (error.reason == "OUT_OF_MEMORY") return ExitStatus::kFailed;  // a full disk is bad input
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
