#pragma once

#include <string>
#include <vector>

namespace hydroprint::rest {

/// A parameter of a hand-written route.
struct OtherParameter {
  std::string name;
  std::string in;    ///< "path", "query" or "header"
  std::string type;  ///< "string" or "integer"
  bool required = false;
  std::string description;
};

/// One possible response of a route.
struct OtherAnswer {
  int status = 200;
  std::string description;
  std::string content_type;  ///< empty: no body
  std::string schema;        ///< full name of the message in the body; empty: bytes or text
  std::vector<OtherParameter> headers;
};

/// A route of daemon/http that has no .proto rule: raw bytes, and information about the daemon
/// itself.
struct OtherRoute {
  std::string http_method;
  std::string path;  ///< "/v1/uploads/{upload}"; each parameter is one segment
  std::string operation;
  std::string tag;
  std::string summary;
  std::string description;
  std::vector<OtherParameter> parameters;
  std::string content_type;  ///< type of the request's body; empty: no body
  std::vector<OtherAnswer> answers;
  bool is_open = false;  ///< needs no authentication
};

/// Returns all such routes, sorted by path.
[[nodiscard]] const std::vector<OtherRoute>& other_routes();

}  // namespace hydroprint::rest
