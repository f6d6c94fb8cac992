#include "client/job.h"

#include <algorithm>
#include <utility>

namespace hydroprint::client {
namespace {

constexpr std::array<std::pair<JobState, std::string_view>, 9> kNames{{
    {JobState::kUnknown, "UNKNOWN"},
    {JobState::kQueued, "QUEUED"},
    {JobState::kWaitingForOperator, "WAITING_FOR_OPERATOR"},
    {JobState::kRunning, "RUNNING"},
    {JobState::kCancelling, "CANCELLING"},
    {JobState::kSucceeded, "SUCCEEDED"},
    {JobState::kFailed, "FAILED"},
    {JobState::kCancelled, "CANCELLED"},
    {JobState::kInterrupted, "INTERRUPTED"},
}};

}  // namespace

std::string_view name_of(JobState state) {
  return std::find_if(kNames.begin(), kNames.end(),
                      [&](const auto& entry) { return entry.first == state; })
      ->second;
}

std::string_view name_of(Verb verb) {
  switch (verb) {
    case Verb::kSimulate:
      return "simulate";
    case Verb::kPredict:
      return "predict";
    case Verb::kFit:
      return "fit";
    case Verb::kValidate:
      return "validate";
    case Verb::kPrintImage:
      return "print-image";
    case Verb::kTemplate:
      return "template";
    case Verb::kCalibrate:
      return "calibrate";
    case Verb::kCalibrateCamera:
      return "calibrate-camera";
  }
  return "unknown";
}

bool is_finished(JobState state) {
  return state == JobState::kSucceeded || state == JobState::kFailed ||
         state == JobState::kCancelled;
}

bool is_finished(const Job& job) {
  const bool is_computed = !job.dip && !job.print_image_job && !job.capture_s;
  return is_finished(job.state) || (!is_computed && job.state == JobState::kInterrupted);
}

}  // namespace hydroprint::client
