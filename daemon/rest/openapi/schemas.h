#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace google::protobuf {
class Descriptor;
class EnumDescriptor;
class FieldDescriptor;
}  // namespace google::protobuf

namespace hydroprint::rest {

/// Direction of a message. Responses contain every field, except unset fields with presence.
/// Requests must contain the required fields and satisfy the other field rules.
enum class Way { kSent, kAnswered };

/// Schemas of OpenAPI 3.0.3 (components.schemas) for messages and enums, with the comments of the
/// .proto files.
class Schemas {
 public:
  /// Marks a message as the response of a route. Call this for all responses before the first
  /// reference().
  void expect_answer(const google::protobuf::Descriptor& message);

  /// Returns a reference to the schema of a message, and adds the schema and the schemas that it
  /// needs. If requests and responses differ, the schemas are "JobInput" and "Job".
  nlohmann::ordered_json reference(const google::protobuf::Descriptor& message, Way way);

  /// Same as reference(), for a request whose path contains the given fields, which the schema
  /// omits. Replaces a schema that is stored under the name of the message.
  nlohmann::ordered_json reference_without(const google::protobuf::Descriptor& message,
                                           const std::set<std::string>& fields);

  /// Returns the schema of a field, with its description.
  nlohmann::ordered_json of_field(const google::protobuf::FieldDescriptor& field, Way way);

  /// Returns a reference to the schema of an enum, and adds the schema: the list of its names.
  nlohmann::ordered_json reference(const google::protobuf::EnumDescriptor& names);

  /// Adds a schema that does not belong to a message.
  void add(const std::string& name, nlohmann::ordered_json schema);

  /// Returns the schema that a reference from this object points to.
  [[nodiscard]] const nlohmann::ordered_json& at(const nlohmann::ordered_json& reference) const;

  /// Returns all schemas, by name.
  [[nodiscard]] const nlohmann::ordered_json& all() const { return all_; }

 private:
  nlohmann::ordered_json object(const google::protobuf::Descriptor& message, Way way,
                                const std::set<std::string>& without);
  nlohmann::ordered_json of_value(const google::protobuf::FieldDescriptor& field, Way way);

  std::set<const google::protobuf::Descriptor*> answered_;  // responses and messages inside them
  nlohmann::ordered_json all_ = nlohmann::ordered_json::object();
};

/// Returns the description of a field: its comment, and the fields that exclude it.
[[nodiscard]] std::string description_of(const google::protobuf::FieldDescriptor& field);

}  // namespace hydroprint::rest
