#include "daemon/rest/path_template.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "daemon/rest/percent.h"

namespace hydroprint::rest {
namespace {

using Kind = Segment::Kind;

constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
constexpr std::string_view kNameMarks = "0123456789_";
constexpr std::string_view kLiteralMarks = "0123456789-_.~%";

bool is_one_of(char c, std::string_view marks) {
  return kLetters.find(c) != std::string_view::npos || marks.find(c) != std::string_view::npos;
}

// Parses a template from left to right.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Result<PathTemplate> parse() {
    if (!take('/')) return refuse("must begin with a slash");
    do {
      HP_RETURN_IF_ERROR(take('{') ? variable() : segment());
    } while (take('/'));
    if (take(':')) {
      HP_ASSIGN_OR_RETURN(result_.verb, literal());
    }
    if (at_ != text_.size()) return refuse("expected a slash, a verb or the end");
    HP_RETURN_IF_ERROR(check());
    return std::move(result_);
  }

 private:
  [[nodiscard]] tl::unexpected<Error> refuse(const std::string& what) const {
    return fail(Code::kInvalidArgument,
                fmt::format("path template \"{}\", byte {}: {}", text_, at_, what));
  }

  bool take(char c) {
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  std::string_view take_all(std::string_view marks) {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_one_of(text_[at_], marks)) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  Result<std::string> literal() {
    const std::string_view text = take_all(kLiteralMarks);
    if (text.empty()) return refuse("a literal is missing");
    return decode(text);
  }

  Status segment() {
    Segment part;
    if (take('*')) {
      part.kind = take('*') ? Kind::kRest : Kind::kOne;
    } else {
      HP_ASSIGN_OR_RETURN(part.literal, literal());
    }
    result_.segments.push_back(std::move(part));
    return {};
  }

  Status variable() {
    Variable found;
    found.begin = result_.segments.size();
    do {
      const std::string_view name = take_all(kNameMarks);
      if (name.empty() || (name[0] >= '0' && name[0] <= '9'))
        return refuse("expected a field name");
      if (!found.field_path.empty()) found.field_path += '.';
      found.field_path += name;
    } while (take('.'));
    if (take('=')) {
      do {
        HP_RETURN_IF_ERROR(segment());
      } while (take('/'));
    } else {
      result_.segments.push_back({.kind = Kind::kOne, .literal = {}});
    }
    if (!take('}')) return refuse("} is missing");
    found.end = result_.segments.size();
    result_.variables.push_back(std::move(found));
    return {};
  }

  Status check() const {
    for (std::size_t i = 0; i + 1 < result_.segments.size(); ++i) {
      if (result_.segments[i].kind == Kind::kRest) return refuse("** must come last");
    }
    for (const Variable& a : result_.variables) {
      const auto same = [&](const Variable& b) { return a.field_path == b.field_path; };
      if (std::count_if(result_.variables.begin(), result_.variables.end(), same) > 1) {
        return refuse("field " + a.field_path + " is bound twice");
      }
    }
    return {};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  PathTemplate result_;
};

bool ends_open(const PathTemplate& path_template) {
  return path_template.segments.back().kind == Kind::kRest;
}

// Returns the number of segments, not counting a final `**`.
std::size_t fixed_count(const PathTemplate& path_template) {
  return path_template.segments.size() - (ends_open(path_template) ? 1 : 0);
}

bool takes_count(const PathTemplate& path_template, std::size_t count) {
  const std::size_t fixed = fixed_count(path_template);
  return ends_open(path_template) ? count >= fixed : count == fixed;
}

std::string value_of(const Variable& variable, const PathTemplate& path_template,
                     const Path& path) {
  const bool is_open = path_template.segments[variable.end - 1].kind == Kind::kRest;
  const std::size_t end = is_open ? path.segments.size() : variable.end;
  const bool is_single = variable.end - variable.begin == 1 && !is_open;
  std::string value;
  for (std::size_t i = variable.begin; i < end; ++i) {
    if (i > variable.begin) value += '/';
    // Decoding cannot fail, because split_path() has already decoded the whole path.
    value += *decode(path.segments[i], is_single ? Keep::kNothing : Keep::kSlash);
  }
  return value;
}

}  // namespace

Result<PathTemplate> parse_template(std::string_view text) { return Parser(text).parse(); }

Result<std::optional<Path>> split_path(std::string_view path) {
  HP_RETURN_IF_ERROR(decode(path));
  if (path.empty() || path[0] != '/') return std::nullopt;
  Path result;
  const std::size_t last_slash = path.rfind('/');
  const std::size_t colon = path.rfind(':');
  if (colon != std::string_view::npos && colon > last_slash) {
    HP_ASSIGN_OR_RETURN(result.verb, decode(path.substr(colon + 1)));
    if (result.verb.empty()) return std::nullopt;
    path = path.substr(0, colon);
  }
  while (!path.empty()) {
    path.remove_prefix(1);
    const std::string_view segment = path.substr(0, path.find('/'));
    if (segment.empty()) return std::nullopt;
    result.segments.emplace_back(segment);
    path.remove_prefix(segment.size());
  }
  return result;
}

std::optional<std::vector<std::string>> match(const PathTemplate& path_template, const Path& path) {
  if (path.verb != path_template.verb) return std::nullopt;
  if (!takes_count(path_template, path.segments.size())) return std::nullopt;
  for (std::size_t i = 0; i < fixed_count(path_template); ++i) {
    const Segment& segment = path_template.segments[i];
    if (segment.kind == Kind::kLiteral && *decode(path.segments[i]) != segment.literal) {
      return std::nullopt;
    }
  }
  std::vector<std::string> values;
  for (const Variable& variable : path_template.variables) {
    values.push_back(value_of(variable, path_template, path));
  }
  return values;
}

bool overlap(const PathTemplate& a, const PathTemplate& b) {
  if (a.verb != b.verb) return false;
  const std::size_t longer = std::max(fixed_count(a), fixed_count(b));
  if (!takes_count(a, longer) || !takes_count(b, longer)) return false;
  for (std::size_t i = 0; i < std::min(fixed_count(a), fixed_count(b)); ++i) {
    const Segment& one = a.segments[i];
    const Segment& other = b.segments[i];
    const bool are_texts = one.kind == Kind::kLiteral && other.kind == Kind::kLiteral;
    if (are_texts && one.literal != other.literal) return false;
  }
  return true;
}

}  // namespace hydroprint::rest
