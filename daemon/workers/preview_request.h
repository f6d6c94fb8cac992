#pragma once

#include <string>
#include <vector>

#include "daemon/store/job.h"

namespace hydroprint::v1 {
class ComputePreviewRequest;
class ReadModelRequest;
}  // namespace hydroprint::v1

namespace hydroprint::daemon {

/// A preview request, ready for a worker's verb `preview` (sim/worker/verbs/preview.h).
struct PreviewRequest {
  std::string key;   ///< requests with equal keys have the same mesh, so one worker can answer them
  std::string spec;  ///< JSON spec of that worker
  std::vector<InputFile> inputs;  ///< input files of that worker
  /// Members of the request's JSON object, without braces; empty: none. They ask for a dip, or for
  /// the model itself.
  std::string dip;
};

/// Checks and translates a request. Errors as in check_job().
[[nodiscard]] Result<PreviewRequest> check_preview(const v1::ComputePreviewRequest& request);

/// Same as above, for reading a model. The key is that of previews of the model without a profile.
[[nodiscard]] Result<PreviewRequest> check_read(const v1::ReadModelRequest& request);

}  // namespace hydroprint::daemon
