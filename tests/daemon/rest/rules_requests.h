#pragma once

#include <string>

#include "daemon/rest/transcoder.h"

namespace hydroprint::rest {

/// Of the service Rules in rules/rules.proto, whose requests are all of type Everything.
const Transcoder& rules();

/// The request that it reads, as JSON of what is set; else the reason and what is wrong. Whatever
/// is wrong must be kInvalidArgument and told in one line.
std::string read(const std::string& http_method, const std::string& target,
                 const std::string& body = "");

}  // namespace hydroprint::rest
