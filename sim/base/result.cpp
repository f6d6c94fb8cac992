#include "sim/base/result.h"

namespace hydroprint {

ExitStatus exit_status(const Error& error) {
  switch (error.code) {
    case Code::kCancelled:
      return ExitStatus::kCancelled;
    case Code::kUnimplemented:
      return ExitStatus::kUsage;
    case Code::kInternal:
    case Code::kUnavailable:
    case Code::kAborted:
    case Code::kDataLoss:
      return ExitStatus::kFailed;
    default:
      return ExitStatus::kBadInput;
  }
}

}  // namespace hydroprint
