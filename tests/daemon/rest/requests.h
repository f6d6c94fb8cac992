#pragma once

#include <google/protobuf/message.h>

#include <random>
#include <string>
#include <vector>

#include "daemon/rest/routes.h"
#include "tests/daemon/rest/random_message.h"

namespace hydroprint::rest {

/// A path that the route has, with some value for each variable.
std::string some_path(const Route& route);

/// "GET, POST".
std::string joined(const std::vector<std::string>& words);

/// A request as a client writes it.
struct Sent {
  std::string target;
  std::string body;
};

/// What a client sends so that the route gets this message; fields that cannot be sent (a list of
/// messages in a query, say) are removed from it, and those that the path needs are set.
Sent sent(const Route& route, google::protobuf::Message& message, std::mt19937& random);

}  // namespace hydroprint::rest
