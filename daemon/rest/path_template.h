#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// One part of a path template between slashes.
struct Segment {
  enum class Kind {
    kLiteral,  ///< this text
    kOne,      ///< `*`: any one segment
    kRest,     ///< `**`: any segments, also none; only ever the last
  };
  Kind kind = Kind::kLiteral;
  std::string literal;  ///< decoded; of kLiteral alone
};

/// `{name=jobs/*}`: the segments [begin, end) of the template give the field `field_path`.
struct Variable {
  std::string field_path;  ///< "name", "job.name"
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// A path template of google/api/http.proto.
struct PathTemplate {
  std::vector<Segment> segments;
  std::vector<Variable> variables;  ///< from left to right
  std::string verb;                 ///< "cancel" of "/v1/jobs/7:cancel"; empty: none
};

/// Reads "/v1/{name=jobs/*}:cancel". Refused (kInvalidArgument): all that the grammar in http.proto
/// does not have, `**` that is not last, a field that is bound twice.
[[nodiscard]] Result<PathTemplate> parse_template(std::string_view text);

/// The path of a request, taken apart.
struct Path {
  std::vector<std::string> segments;  ///< still percent-encoded
  std::string verb;  ///< decoded: what follows the last colon of the last segment; empty: none
};

/// Takes "/v1/jobs/7:cancel" apart; none for a path that no template can match: one that does not
/// begin with a slash, has empty segments, ends with a slash or with a colon. Refused
/// (kInvalidArgument, URL_INVALID): escapes that are none, and text that is not UTF-8 or holds NUL
/// once decoded, or has characters that a request line cannot have.
[[nodiscard]] Result<std::optional<Path>> split_path(std::string_view path);

/// The values of a template's variables, in their order, if the path matches it. A variable of one
/// segment is decoded; in one of several, %2F stays.
[[nodiscard]] std::optional<std::vector<std::string>> match(const PathTemplate& path_template,
                                                            const Path& path);

/// Whether some path matches both.
[[nodiscard]] bool overlap(const PathTemplate& a, const PathTemplate& b);

}  // namespace hydroprint::rest
