#pragma once

#include <string>
#include <vector>

namespace hydroprint::rest {

/// A parameter of a route that is written by hand.
struct OtherParameter {
  std::string name;
  std::string in;    ///< "path", "query" or "header"
  std::string type;  ///< "string" or "integer"
  bool required = false;
  std::string description;
};

/// One answer to it.
struct OtherAnswer {
  int status = 200;
  std::string description;
  std::string content_type;  ///< empty: no body
  std::string schema;        ///< full name of a message; empty: bytes or text
  std::vector<OtherParameter> headers;
};

/// A route that daemon/http has besides those of the .proto files: bytes as they are, and what
/// tells of the daemon itself.
struct OtherRoute {
  std::string http_method;
  std::string path;  ///< "/v1/uploads/{upload}"; a parameter is one segment
  std::string operation;
  std::string tag;
  std::string summary;
  std::string description;
  std::vector<OtherParameter> parameters;
  std::string content_type;  ///< of the request's body; empty: it has none
  std::vector<OtherAnswer> answers;
  bool is_open = false;  ///< whoever reaches the daemon may ask
};

/// All of them, by path.
[[nodiscard]] const std::vector<OtherRoute>& other_routes();

}  // namespace hydroprint::rest
