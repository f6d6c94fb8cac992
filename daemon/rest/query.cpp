#include "daemon/rest/query.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <set>

#include "daemon/rest/percent.h"
#include "daemon/rest/values.h"

namespace hydroprint::rest {
namespace {

// Returns whether the fields are equal, or one contains the other.
bool are_one(const FieldPath& a, const FieldPath& b) {
  return std::equal(a.begin(), a.begin() + static_cast<long>(std::min(a.size(), b.size())),
                    b.begin());
}

Status check_free(const Route& route, const FieldPath& path) {
  for (const FieldPath& bound : route.path_fields) {
    if (are_one(bound, path))
      return bad_parameter(path_text(path), "is already set by the path; leave it out");
  }
  const bool in_body = route.body == Body::kAll || path.front() == route.body_field;
  return in_body ? bad_parameter(path_text(path), "belongs in the body") : Status{};
}

Status read_pair(std::string_view pair, const Route& route, std::set<FieldPath>& given,
                 google::protobuf::Message& request) {
  const std::size_t equals = pair.find('=');
  HP_ASSIGN_OR_RETURN(const std::string name, decode_query(pair.substr(0, equals)));
  const auto path = find_field(*request.GetDescriptor(), name);
  if (!path) return bad_parameter(plain(name), path.error().message);
  HP_RETURN_IF_ERROR(check_free(route, *path));
  if (equals == std::string_view::npos) return bad_parameter(path_text(*path), "\"=\" is missing");
  if (!given.insert(*path).second && !path->back()->is_repeated()) {
    return bad_parameter(path_text(*path), "is given twice");
  }
  HP_ASSIGN_OR_RETURN(const std::string value, decode_query(pair.substr(equals + 1)));
  return set_from_text(request, *path, value);
}

}  // namespace

Status read_query(std::string_view query, const Route& route, google::protobuf::Message& request) {
  std::set<FieldPath> given;
  while (!query.empty()) {
    const std::string_view pair = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), pair.size() + 1));
    if (pair.empty()) continue;
    HP_RETURN_IF_ERROR(read_pair(pair, route, given, request));
  }
  return {};
}

}  // namespace hydroprint::rest
