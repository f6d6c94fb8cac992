#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hydroprint::http {

/// The parts of a download target, "/v1/jobs/7/artifacts/film.png:download?inline=1".
struct ArtifactPath {
  std::string name;        ///< "jobs/7/artifacts/film.png"; decoded, not checked
  bool is_inline = false;  ///< the browser should display the artifact instead of saving it
  bool is_good = true;     ///< false: a malformed escape, or a query other than inline=1
};

/// Parses the target of a download; nullopt for any other target.
[[nodiscard]] std::optional<ArtifactPath> artifact_target(std::string_view target);

}  // namespace hydroprint::http
