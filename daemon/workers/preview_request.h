#pragma once

#include <string>
#include <vector>

#include "daemon/store/job.h"

namespace hydroprint::v1 {
class ComputePreviewRequest;
}

namespace hydroprint::daemon {

/// What a preview is asked of, ready for a worker's verb `preview` (sim/worker/verbs/preview.h).
struct PreviewRequest {
  std::string key;   ///< the same for whatever one worker can answer, which has the mesh in memory
  std::string spec;  ///< that worker's, as JSON
  std::vector<InputFile> inputs;  ///< and files
  std::string dip;  ///< keys of one request, as the inside of a JSON object; empty: none
};

/// Checks and translates a request; refuses as check_job() does.
[[nodiscard]] Result<PreviewRequest> check_preview(const v1::ComputePreviewRequest& request);

}  // namespace hydroprint::daemon
