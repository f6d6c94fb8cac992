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

/// Which way a message goes. Answers have all their fields but those that may be unset. What is
/// sent has to have the fields that are required, and is held to their other rules.
enum class Way { kSent, kAnswered };

/// Schemas of OpenAPI 3.0.3 (components.schemas) for messages and enums, with the protos' comments.
class Schemas {
 public:
  /// Says that this message is answered by some route; to be said of all before anything is
  /// referred to.
  void expect_answer(const google::protobuf::Descriptor& message);

  /// A reference to the schema of a message, which is added with all that it needs. One that goes
  /// both ways and then differs is "Job" as an answer and "JobInput" as sent.
  nlohmann::ordered_json reference(const google::protobuf::Descriptor& message, Way way);

  /// The same, without the fields of that name: the path gives them. A schema of its own, under the
  /// message's name.
  nlohmann::ordered_json reference_without(const google::protobuf::Descriptor& message,
                                           const std::set<std::string>& fields);

  /// Schema of a field, with its description.
  nlohmann::ordered_json of_field(const google::protobuf::FieldDescriptor& field, Way way);

  /// A reference to the schema of an enum, which is added: its names.
  nlohmann::ordered_json reference(const google::protobuf::EnumDescriptor& names);

  /// Adds one that no message has.
  void add(const std::string& name, nlohmann::ordered_json schema);

  /// What a reference leads to; it must be one from here.
  [[nodiscard]] const nlohmann::ordered_json& at(const nlohmann::ordered_json& reference) const;

  /// All of them, by name.
  [[nodiscard]] const nlohmann::ordered_json& all() const { return all_; }

 private:
  nlohmann::ordered_json object(const google::protobuf::Descriptor& message, Way way,
                                const std::set<std::string>& without);
  nlohmann::ordered_json of_value(const google::protobuf::FieldDescriptor& field, Way way);

  std::set<const google::protobuf::Descriptor*> answered_;  // and all that is in them
  nlohmann::ordered_json all_ = nlohmann::ordered_json::object();
};

/// What is said of a field: its comment, and which others exclude it.
[[nodiscard]] std::string description_of(const google::protobuf::FieldDescriptor& field);

}  // namespace hydroprint::rest
