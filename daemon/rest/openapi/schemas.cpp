#include "daemon/rest/openapi/schemas.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <cmath>
#include <map>
#include <utility>

#include "daemon/rest/routes.h"
#include "hydroprint/v1/field_rules.pb.h"
#include "proto/rules/comments.h"
#include "proto/rules/field_rules.h"

namespace hydroprint::rest {
namespace {

namespace pb = google::protobuf;
using Json = nlohmann::ordered_json;
using Type = pb::FieldDescriptor::CppType;

// Returns the name within the package: "Job.State".
template <class Descriptor>
std::string short_name(const Descriptor& descriptor) {
  const std::string& package = descriptor.file()->package();
  return descriptor.full_name().substr(package.empty() ? 0 : package.size() + 1);
}

const std::string kPlace = "#/components/schemas/";

Json reference_to(const std::string& name) { return {{"$ref", kPlace + name}}; }

bool is_oneof_member(const pb::FieldDescriptor& field) {
  return field.real_containing_oneof() != nullptr;
}

// Returns whether responses always contain the field.
bool is_always_there(const pb::FieldDescriptor& field) {
  return field.is_repeated() || !field.has_presence();
}

const v1::FieldRules& rules_of(const pb::FieldDescriptor& field) {
  const v1::FieldRules* const found = rules::rules_of(field);
  return found == nullptr ? v1::FieldRules::default_instance() : *found;
}

bool is_required(const pb::FieldDescriptor& field) {
  return rules_of(field).required() && rules_of(field).unless().empty();
}

// Returns whether the schemas for requests and responses differ, for the message or for a message
// inside it.
bool differs(const pb::Descriptor& message, std::set<const pb::Descriptor*>& seen) {
  if (!seen.insert(&message).second) return false;
  for (int i = 0; i < message.field_count(); ++i) {
    const pb::FieldDescriptor& field = *message.field(i);
    if (is_always_there(field) || rules::rules_of(field) != nullptr) return true;
    const bool is_object = field.message_type() != nullptr && !is_written_as_value(field);
    if (is_object && differs(*field.message_type(), seen)) return true;
  }
  return false;
}

Json string_of(const char* format) { return {{"type", "string"}, {"format", format}}; }

// Returns the schemas of Timestamp and the other well-known types in their JSON form.
Json of_well_known(const pb::Descriptor& type) {
  static const std::map<std::string, Json> kSchemas = {
      {"Timestamp", string_of("date-time")},
      {"Duration",
       {{"type", "string"}, {"format", "duration"}, {"pattern", R"(^-?[0-9]+(\.[0-9]{1,9})?s$)"}}},
      {"FieldMask", string_of("field-mask")},
      {"BoolValue", {{"type", "boolean"}}},
      {"StringValue", {{"type", "string"}}},
      {"BytesValue", string_of("byte")},
      {"Int32Value", {{"type", "integer"}, {"format", "int32"}}},
      {"UInt32Value", {{"type", "integer"}, {"format", "uint32"}, {"minimum", 0}}},
      {"Int64Value", string_of("int64")},
      {"UInt64Value", string_of("uint64")},
      {"FloatValue", {{"type", "number"}, {"format", "float"}}},
      {"DoubleValue", {{"type", "number"}, {"format", "double"}}}};
  return kSchemas.at(type.name());
}

Json of_scalar(const pb::FieldDescriptor& field) {
  switch (field.cpp_type()) {
    case Type::CPPTYPE_INT32:
      return {{"type", "integer"}, {"format", "int32"}};
    case Type::CPPTYPE_UINT32:
      return {{"type", "integer"}, {"format", "uint32"}, {"minimum", 0}};
    case Type::CPPTYPE_INT64:
      return string_of("int64");
    case Type::CPPTYPE_UINT64:
      return string_of("uint64");
    case Type::CPPTYPE_DOUBLE:
      return {{"type", "number"}, {"format", "double"}};
    case Type::CPPTYPE_FLOAT:
      return {{"type", "number"}, {"format", "float"}};
    case Type::CPPTYPE_BOOL:
      return {{"type", "boolean"}};
    default:
      return field.type() == pb::FieldDescriptor::TYPE_BYTES ? string_of("byte")
                                                             : Json{{"type", "string"}};
  }
}

// Adds a description. A reference cannot have one, so it is wrapped in allOf.
Json described(Json schema, const std::string& description) {
  if (description.empty()) return schema;
  if (schema.contains("$ref")) schema = {{"allOf", Json::array({std::move(schema)})}};
  schema["description"] = description;
  return schema;
}

// Writes whole numbers without a decimal point.
Json number_of(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

// Converts a value that the rules contain as text to the field's JSON type; null if it is the name
// of a value ("full").
Json value_in(const pb::FieldDescriptor& field, const std::string& text) {
  if (text.empty()) return nullptr;
  const Json parsed = Json::parse(text, nullptr, false);
  if (field.is_repeated()) return parsed.is_array() ? parsed : Json();
  switch (field.cpp_type()) {
    case Type::CPPTYPE_INT32:
    case Type::CPPTYPE_UINT32:
    case Type::CPPTYPE_DOUBLE:
    case Type::CPPTYPE_FLOAT:
      return parsed.is_number() ? parsed : Json();
    case Type::CPPTYPE_BOOL:
      return parsed.is_boolean() ? parsed : Json();
    default:
      return text;
  }
}

// Adds the rules for a value of the field in requests: ranges, lengths, choices.
void add_limits(const v1::FieldRules& rules, Json& schema) {
  const bool is_number =
      schema.value("type", "") == "number" || schema.value("type", "") == "integer";
  const bool is_text = schema.value("type", "") == "string" && !schema.contains("format");
  if (is_number && rules.has_min()) schema["minimum"] = number_of(rules.min());
  if (is_number && rules.above_min()) schema["exclusiveMinimum"] = true;
  if (is_number && rules.has_max()) schema["maximum"] = number_of(rules.max());
  // JSON Schema counts characters, the rule counts UTF-8 bytes. A text beyond maxLength also breaks
  // the rule, because each character has at least one byte.
  if (is_text && rules.max_bytes() > 0) {
    schema["maxLength"] = rules.max_bytes();
    schema["x-max-bytes"] = rules.max_bytes();
  }
  if (is_text && !rules.format().empty()) schema["format"] = rules.format();
  for (const std::string& value : rules.values()) schema["enum"].push_back(value);
}

// Adds the rules for the field as a whole. JSON Schema has no keyword for units.
void add_field_rules(const pb::FieldDescriptor& field, Way way, Json& schema) {
  const v1::FieldRules& rules = rules_of(field);
  if (!rules.unit().empty()) schema["x-unit"] = rules.unit();
  if (rules.read_only()) schema["readOnly"] = true;
  if (way != Way::kSent) return;
  const char* const kind = field.is_map() ? "Properties" : "Items";
  if (rules.min_items() > 0) schema[std::string("min") + kind] = rules.min_items();
  if (rules.max_items() > 0) schema[std::string("max") + kind] = rules.max_items();
  if (Json value = value_in(field, rules.default_value()); !value.is_null()) {
    schema["default"] = std::move(value);
  }
  if (Json value = value_in(field, rules.example()); !value.is_null()) {
    schema["example"] = std::move(value);
  }
}

// Returns sentences about the oneofs: "At most one of a, b is set (spec: what to do)."
std::string oneofs_of(const pb::Descriptor& message) {
  std::string text;
  for (int i = 0; i < message.real_oneof_decl_count(); ++i) {
    const pb::OneofDescriptor& oneof = *message.oneof_decl(i);
    std::string names;
    for (int k = 0; k < oneof.field_count(); ++k) {
      names += (k == 0 ? "`" : ", `") + oneof.field(k)->json_name() + "`";
    }
    text += fmt::format("\n\nAt most one of {} is set. {}", names,
                        rules::comment_on(oneof.full_name()));
  }
  return text;
}

}  // namespace

std::string description_of(const pb::FieldDescriptor& field) {
  std::string text = rules::comment_on(field.full_name());
  if (is_oneof_member(field)) {
    text += fmt::format("{}At most one of `{}` is set.", text.empty() ? "" : "\n",
                        field.real_containing_oneof()->name());
  }
  return text;
}

void Schemas::expect_answer(const pb::Descriptor& message) {
  if (!answered_.insert(&message).second) return;
  for (int i = 0; i < message.field_count(); ++i) {
    const pb::Descriptor* inner = message.field(i)->message_type();
    if (inner != nullptr) expect_answer(*inner);
  }
}

Json Schemas::reference(const pb::Descriptor& message, Way way) {
  std::set<const pb::Descriptor*> seen;
  std::string name = short_name(message);
  const bool goes_both_ways = way == Way::kSent && answered_.count(&message) > 0;
  if (goes_both_ways && differs(message, seen)) name += "Input";
  if (!all_.contains(name)) {
    all_[name] = nullptr;  // a placeholder, because the schema may refer to itself
    all_[name] = object(message, way, {});
  }
  return reference_to(name);
}

Json Schemas::reference_without(const pb::Descriptor& message,
                                const std::set<std::string>& fields) {
  add(short_name(message), object(message, Way::kSent, fields));
  return reference_to(short_name(message));
}

Json Schemas::reference(const pb::EnumDescriptor& names) {
  const std::string name = short_name(names);
  if (all_.contains(name)) return reference_to(name);
  Json values = Json::array();
  std::string description = rules::comment_on(names.full_name()) + "\n";
  for (int i = 0; i < names.value_count(); ++i) {
    const std::string& value = names.value(i)->name();
    values.push_back(value);
    description +=
        fmt::format("\n- `{}`: {}", value, rules::comment_on(names.full_name() + "." + value));
  }
  all_[name] = {{"type", "string"}, {"enum", values}, {"description", description}};
  return reference_to(name);
}

void Schemas::add(const std::string& name, Json schema) { all_[name] = std::move(schema); }

const Json& Schemas::at(const Json& reference) const {
  return all_.at(reference.at("$ref").get<std::string>().substr(kPlace.size()));
}

Json Schemas::of_value(const pb::FieldDescriptor& field, Way way) {
  if (is_written_as_value(field)) return of_well_known(*field.message_type());
  if (field.message_type() != nullptr) return reference(*field.message_type(), way);
  if (field.enum_type() != nullptr) return reference(*field.enum_type());
  return of_scalar(field);
}

Json Schemas::of_field(const pb::FieldDescriptor& field, Way way) {
  Json schema = of_value(field.is_map() ? *field.message_type()->map_value() : field, way);
  if (way == Way::kSent) add_limits(rules_of(field), schema);
  if (field.is_map()) {
    schema = {{"type", "object"}, {"additionalProperties", std::move(schema)}};
  } else if (field.is_repeated()) {
    schema = {{"type", "array"}, {"items", std::move(schema)}};
  }
  schema = described(std::move(schema), description_of(field));
  add_field_rules(field, way, schema);
  return schema;
}

Json Schemas::object(const pb::Descriptor& message, Way way, const std::set<std::string>& without) {
  Json schema = {{"type", "object"}};
  const std::string description = rules::comment_on(message.full_name()) + oneofs_of(message);
  if (!description.empty()) schema["description"] = description;
  Json properties = Json::object();
  Json required = Json::array();
  for (int i = 0; i < message.field_count(); ++i) {
    const pb::FieldDescriptor& field = *message.field(i);
    if (without.count(field.name()) > 0) continue;
    properties[field.json_name()] = of_field(field, way);
    const bool needed = way == Way::kSent ? is_required(field) : is_always_there(field);
    if (needed) required.push_back(field.json_name());
  }
  if (!properties.empty()) schema["properties"] = std::move(properties);
  if (!required.empty()) schema["required"] = std::move(required);
  if (way == Way::kSent || message.field_count() == 0) schema["additionalProperties"] = false;
  return schema;
}

}  // namespace hydroprint::rest
