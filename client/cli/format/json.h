#pragma once

#include <google/protobuf/message.h>

#include <nlohmann/json.hpp>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::cli {

/// The output of --json: messages of the API in the format of the REST API.
using Json = nlohmann::ordered_json;

[[nodiscard]] Json to_json(const google::protobuf::Message& message);
[[nodiscard]] Json to_json(const Error& error);

/// Converts a message for print_tree(): with the field names of the .proto files.
[[nodiscard]] Json tree_of(const google::protobuf::Message& message);

/// Prints JSON in readable form: one field per line, list items one below the other. Empty fields
/// are omitted.
void print_tree(const Json& json, const std::string& indent = "");

/// Prints JSON on one line of standard output.
void print(const Json& json);
/// Same as above, for a message.
void print(const google::protobuf::Message& message);

}  // namespace hydroprint::cli
