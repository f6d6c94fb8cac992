#include "daemon/store/job.h"

#include <algorithm>

#include "sim/base/sha256.h"

namespace hydroprint::daemon {

const char* name_of(JobState state) {
  switch (state) {
    case JobState::kQueued:
      return "QUEUED";
    case JobState::kWaitingForOperator:
      return "WAITING_FOR_OPERATOR";
    case JobState::kRunning:
      return "RUNNING";
    case JobState::kCancelling:
      return "CANCELLING";
    case JobState::kSucceeded:
      return "SUCCEEDED";
    case JobState::kFailed:
      return "FAILED";
    case JobState::kCancelled:
      return "CANCELLED";
    case JobState::kInterrupted:
      return "INTERRUPTED";
  }
  return "STATE_UNSPECIFIED";
}

std::string input_digest(const Work& work, const std::string& worker) {
  std::string text = "worker " + worker + "\nverb " + work.verb + '\n';
  text += "spec " + work.spec + '\n';
  std::vector<InputFile> inputs = work.inputs;
  std::sort(inputs.begin(), inputs.end(),
            [](const InputFile& a, const InputFile& b) { return a.name < b.name; });
  for (const InputFile& input : inputs) text += "input " + input.sha256 + ' ' + input.name + '\n';
  return sha256(text);
}

}  // namespace hydroprint::daemon
