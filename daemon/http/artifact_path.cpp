#include "daemon/http/artifact_path.h"

#include <vector>

#include "daemon/http/protocol/header_fields.h"
#include "daemon/rest/percent.h"

namespace hydroprint::http {
namespace {

std::string decoded_or_none(std::string_view text, bool& is_good) {
  const Result<std::string> decoded = rest::decode(text);
  if (!decoded || decoded->find('/') != std::string::npos) is_good = false;
  return decoded.value_or("");
}

}  // namespace

std::optional<ArtifactPath> artifact_target(std::string_view target) {
  constexpr std::string_view kJobs = "/v1/jobs/", kArtifacts = "/artifacts/", kVerb = ":download";
  const std::size_t query = std::min(target.find('?'), target.size());
  std::string_view path = target.substr(0, query);
  if (!path.starts_with(kJobs) || !path.ends_with(kVerb)) return {};
  path = path.substr(kJobs.size(), path.size() - kJobs.size() - kVerb.size());
  const std::size_t slash = path.find('/');
  if (slash == std::string_view::npos || !path.substr(slash).starts_with(kArtifacts)) return {};
  const std::string_view file = path.substr(slash + kArtifacts.size());
  if (file.empty() || file.find('/') != std::string_view::npos) return {};

  ArtifactPath found;
  found.name = "jobs/" + decoded_or_none(path.substr(0, slash), found.is_good) + "/artifacts/" +
               decoded_or_none(file, found.is_good);
  for (const std::string_view parameter : parts_of(target.substr(query), '&')) {
    const std::string_view plain = parameter.starts_with('?') ? parameter.substr(1) : parameter;
    if (plain == "inline=1") {
      found.is_inline = true;
    } else if (!plain.empty()) {
      found.is_good = false;
    }
  }
  return found;
}

}  // namespace hydroprint::http
