#include "client/cli/format/json.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <iostream>

#include "client/cli/terminal/console.h"
#include "proto/write_json.h"
#include "sim/base/check.h"

namespace hydroprint::cli {
namespace {

namespace pb = google::protobuf;

// Messages of the API contain no google.protobuf.Any, so they always have a JSON form.
std::string json_text(const pb::Message& message) {
  const auto text = write_json(message);
  HP_CHECK(text.has_value());
  return *text;
}

std::string text_of(const Json& value) {
  return printable(value.is_string() ? value.get<std::string>() : value.dump());
}

bool is_empty(const Json& value) {
  if (value.is_structured()) return value.empty();
  if (!value.is_string()) return false;
  const auto& text = value.get_ref<const std::string&>();
  return text.empty() || text.ends_with("_UNSPECIFIED");
}

}  // namespace

Json to_json(const pb::Message& message) { return Json::parse(json_text(message)); }

Json to_json(const Error& error) {
  Json json{{"code", code_name(error.code)}};
  if (error.reason != ErrorReason{}) json["reason"] = name_of(error.reason);
  json["message"] = error.message;
  if (!error.field.empty()) json["field"] = error.field;
  if (!error.metadata.empty()) json["metadata"] = error.metadata;
  return json;
}

Json tree_of(const pb::Message& message) {
  pb::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string text;
  HP_CHECK(pb::util::MessageToJsonString(message, &text, options).ok());
  return Json::parse(text);
}

void print_tree(const Json& json, const std::string& indent) {
  for (const auto& [key, value] : json.items()) {
    if (is_empty(value)) continue;
    std::cout << fmt::format("{}{:<19} ", indent, key);
    if (value.is_object()) {
      std::cout << "\n";
      print_tree(value, indent + "  ");
    } else if (value.is_array() && !value.front().is_number()) {
      for (const Json& line : value)  // one below the other
        std::cout << (&line == &value.front() ? "" : indent + std::string(20, ' ')) << text_of(line)
                  << "\n";
    } else {
      std::cout << text_of(value) << "\n";
    }
  }
}

void print(const Json& json) {
  // File names are not always UTF-8; invalid bytes are replaced.
  std::cout << json.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
}

void print(const pb::Message& message) { std::cout << json_text(message) << std::endl; }

}  // namespace hydroprint::cli
