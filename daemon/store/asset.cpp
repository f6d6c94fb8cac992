#include "daemon/store/asset.h"

#include <fmt/format.h>

namespace hydroprint::daemon {

tl::unexpected<Error> asset_missing(const InputFile& input) {
  auto error = fail(
      Code::kFailedPrecondition,
      fmt::format("{}: assets/{} does not exist; upload the file first", input.name, input.sha256),
      ErrorReason::ASSET_MISSING);
  error.value().metadata["asset"] = "assets/" + input.sha256;
  return error;
}

tl::unexpected<Error> asset_damaged(const InputFile& input) {
  auto error =
      fail(Code::kDataLoss,
           fmt::format("{}: the stored file assets/{} is damaged; upload the file again and "
                       "retry the job, or submit the job again if it takes the file from "
                       "another job",
                       input.name, input.sha256),
           ErrorReason::ARTIFACT_DAMAGED);
  error.value().metadata["asset"] = "assets/" + input.sha256;
  return error;
}

}  // namespace hydroprint::daemon
