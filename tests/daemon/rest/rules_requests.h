#pragma once

#include <string>

#include "daemon/rest/transcoder.h"

namespace hydroprint::rest {

/// Requests to the service Rules in rules/rules.proto, which all have the type Everything.
const Transcoder& rules();

/// The parsed request as JSON of the fields that are set, otherwise reason and message of the
/// error. Every error must be kInvalidArgument with a message of one line.
std::string read(const std::string& http_method, const std::string& target,
                 const std::string& body = "");

}  // namespace hydroprint::rest
