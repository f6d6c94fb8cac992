#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// One part of a path template, between two slashes.
struct Segment {
  enum class Kind {
    kLiteral,  ///< the text `literal`
    kOne,      ///< `*`: any one segment
    kRest,     ///< `**`: any number of segments, including zero; only as the last segment
  };
  Kind kind = Kind::kLiteral;
  std::string literal;  ///< decoded; only for kLiteral
};

/// `{name=jobs/*}`: the segments [begin, end) of the template are the value of `field_path`.
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

/// Parses "/v1/{name=jobs/*}:cancel". Returns kInvalidArgument for text that does not follow the
/// grammar in http.proto, a `**` that is not last, and a field that is bound twice.
[[nodiscard]] Result<PathTemplate> parse_template(std::string_view text);

/// The path of a request, split into parts.
struct Path {
  std::vector<std::string> segments;  ///< still percent-encoded
  std::string verb;  ///< decoded: the text after the last colon of the last segment; empty: none
};

/// Splits "/v1/jobs/7:cancel". Returns nullopt for a path that no template can match: one that does
/// not begin with a slash, has empty segments, or ends with a slash or a colon. Returns
/// kInvalidArgument, URL_INVALID for malformed escapes, decoded text that is not UTF-8 or contains
/// NUL, and characters that are not allowed in a request line.
[[nodiscard]] Result<std::optional<Path>> split_path(std::string_view path);

/// Returns the values of a template's variables, in order, if the path matches it. The value of a
/// single segment is decoded; in a value of several segments, %2F stays encoded.
[[nodiscard]] std::optional<std::vector<std::string>> match(const PathTemplate& path_template,
                                                            const Path& path);

/// Returns whether any path matches both templates.
[[nodiscard]] bool overlap(const PathTemplate& a, const PathTemplate& b);

}  // namespace hydroprint::rest
