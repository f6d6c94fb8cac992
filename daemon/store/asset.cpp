#include "daemon/store/asset.h"

#include <fmt/format.h>

namespace hydroprint::daemon {

tl::unexpected<Error> asset_missing(const InputFile& input) {
  auto error = fail(
      Code::kFailedPrecondition,
      fmt::format("{}: assets/{} is not on the daemon; upload it first", input.name, input.sha256),
      "ASSET_MISSING");
  error.value().metadata["asset"] = "assets/" + input.sha256;
  return error;
}

}  // namespace hydroprint::daemon
