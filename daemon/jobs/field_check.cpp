#include "daemon/jobs/field_check.h"

#include "daemon/rest/bad_request.h"
#include "proto/rules/check.h"
#include "sim/film/outline.h"
#include "sim/print/settings.h"

namespace hydroprint::daemon {
namespace {

template <class Value>
std::string problem_of(const Result<Value>& parsed) {
  return parsed ? std::string() : parsed.error().message;
}

// Checks a film. The file of a polygon is opened only by the worker.
std::string film_problem(const std::string& text) {
  if (film::polygon_file(text)) return {};
  return problem_of(film::parse_outline(text));
}

std::string paper_problem(const std::string& text) {
  const auto paper_mm = print::parse_paper(text);
  if (!paper_mm) return problem_of(paper_mm);
  print::PageSettings page;
  page.paper_mm = *paper_mm;
  return problem_of(print::check(page));
}

}  // namespace

Status check_fields(const google::protobuf::Message& message) {
  static const rules::FormatChecks formats = {{"film", film_problem}, {"paper", paper_problem}};
  const auto violations = rules::check(message, formats);
  if (violations.empty()) return {};
  return tl::unexpected(rest::bad_request(violations));
}

}  // namespace hydroprint::daemon
