#pragma once

#include <google/protobuf/message.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "daemon/rest/routes.h"

namespace hydroprint::rest {

/// A path that the route has, with some value for each variable.
std::string some_path(const Route& route);

/// "GET, POST".
std::string joined(const std::vector<std::string>& words);

/// An empty message of that type.
std::unique_ptr<google::protobuf::Message> new_message(const google::protobuf::Descriptor& type);

/// A message of that type whose fields were drawn, and those of the messages in it down to
/// `levels`; finite numbers, enum values that exist, texts with anything in them but NUL.
std::unique_ptr<google::protobuf::Message> random_message(const google::protobuf::Descriptor& type,
                                                          std::mt19937& random, int levels);

/// A request as a client writes it.
struct Sent {
  std::string target;
  std::string body;
};

/// What a client sends so that the route gets this message; fields that cannot be sent (a list of
/// messages in a query, say) are removed from it, and those that the path needs are set.
Sent sent(const Route& route, google::protobuf::Message& message, std::mt19937& random);

}  // namespace hydroprint::rest
