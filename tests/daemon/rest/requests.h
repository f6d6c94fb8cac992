#pragma once

#include <google/protobuf/message.h>

#include <random>
#include <string>
#include <vector>

#include "daemon/rest/routes.h"
#include "tests/daemon/rest/random_message.h"

namespace hydroprint::rest {

/// A path that matches the route, with an arbitrary value for each variable.
std::string some_path(const Route& route);

/// Joins words: "GET, POST".
std::string joined(const std::vector<std::string>& words);

/// A request as a client writes it.
struct Sent {
  std::string target;
  std::string body;
};

/// The request with which a client sends this message to the route. Fields that cannot be sent
/// (such as a list of messages in a query) are removed from the message, and fields that the path
/// needs are set.
Sent sent(const Route& route, google::protobuf::Message& message, std::mt19937& random);

}  // namespace hydroprint::rest
