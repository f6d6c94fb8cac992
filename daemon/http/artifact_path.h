#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hydroprint::http {

/// What is asked for by "/v1/jobs/7/artifacts/film.png:download?inline=1".
struct ArtifactPath {
  std::string name;        ///< "jobs/7/artifacts/film.png"; decoded, not checked
  bool is_inline = false;  ///< to be shown, not to be kept
  bool is_good = true;     ///< false: an escape is none, or another query than inline=1
};

/// Reads that; nothing for any other target.
[[nodiscard]] std::optional<ArtifactPath> artifact_target(std::string_view target);

}  // namespace hydroprint::http
