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

/// Direction of a message. Answers contain every field, except fields with presence that are unset.
/// Sent messages must contain the required fields and satisfy the other field rules.
enum class Way { kSent, kAnswered };

/// Schemas of OpenAPI 3.0.3 (components.schemas) for messages and enums, with the protos' comments.
class Schemas {
 public:
  /// Marks a message as the answer of some route. Call this for all answers before the first
  /// reference().
  void expect_answer(const google::protobuf::Descriptor& message);

  /// A reference to the schema of a message, which is added together with the schemas it needs. A
  /// message that differs between directions is "Job" as an answer and "JobInput" as sent.
  nlohmann::ordered_json reference(const google::protobuf::Descriptor& message, Way way);

  /// Same, without the fields with these names, which the path gives. The schema is separate, under
  /// the message's name.
  nlohmann::ordered_json reference_without(const google::protobuf::Descriptor& message,
                                           const std::set<std::string>& fields);

  /// Schema of a field, with its description.
  nlohmann::ordered_json of_field(const google::protobuf::FieldDescriptor& field, Way way);

  /// A reference to the schema of an enum, which is added: the list of its names.
  nlohmann::ordered_json reference(const google::protobuf::EnumDescriptor& names);

  /// Adds a schema that does not belong to a message.
  void add(const std::string& name, nlohmann::ordered_json schema);

  /// The schema that a reference from this object points to.
  [[nodiscard]] const nlohmann::ordered_json& at(const nlohmann::ordered_json& reference) const;

  /// All schemas, by name.
  [[nodiscard]] const nlohmann::ordered_json& all() const { return all_; }

 private:
  nlohmann::ordered_json object(const google::protobuf::Descriptor& message, Way way,
                                const std::set<std::string>& without);
  nlohmann::ordered_json of_value(const google::protobuf::FieldDescriptor& field, Way way);

  std::set<const google::protobuf::Descriptor*> answered_;  // including the messages inside
  nlohmann::ordered_json all_ = nlohmann::ordered_json::object();
};

/// Description of a field: its comment, and the fields that exclude it.
[[nodiscard]] std::string description_of(const google::protobuf::FieldDescriptor& field);

}  // namespace hydroprint::rest
