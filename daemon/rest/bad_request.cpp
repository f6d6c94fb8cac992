#include "daemon/rest/bad_request.h"

#include <algorithm>
#include <string_view>

namespace hydroprint::rest {
namespace {

// Maximum number of violations in an error, because gRPC limits the size of its details to 8 KiB.
constexpr std::size_t kMostViolations = 16;
// Prefix of a violation's metadata key; it is followed by a letter that keeps the order, and the
// field.
constexpr std::string_view kPrefix = "violation-";

bool is_violation(const std::string& key) { return key.starts_with(kPrefix); }

}  // namespace

Error bad_request(const std::vector<rules::Violation>& violations) {
  const rules::Violation& first = violations.front();
  Error error{Code::kInvalidArgument, "", first.reason, {}, first.field};
  for (std::size_t i = 0; i < std::min(violations.size(), kMostViolations); ++i) {
    const rules::Violation& violation = violations[i];
    error.message += i == 0 ? violation.problem : "; " + violation.field + ": " + violation.problem;
    error.metadata[std::string(kPrefix) + static_cast<char>('a' + i) + violation.field] =
        violation.problem;
  }
  return error;
}

std::vector<rules::Violation> violations_of(const Error& error) {
  std::vector<rules::Violation> violations;
  for (const auto& [key, problem] : error.metadata) {
    if (!is_violation(key)) continue;
    violations.push_back({key.substr(kPrefix.size() + 1), problem, error.reason});
  }
  if (!violations.empty() || error.field.empty()) return violations;
  return {{error.field, error.message, error.reason}};
}

std::map<std::string, std::string> shown_metadata(const Error& error) {
  std::map<std::string, std::string> shown = error.metadata;
  std::erase_if(shown, [](const auto& entry) { return is_violation(entry.first); });
  if (!error.field.empty()) shown["field"] = error.field;
  return shown;
}

}  // namespace hydroprint::rest
