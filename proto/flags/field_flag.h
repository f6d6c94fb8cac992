#pragma once

#include <google/protobuf/message.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

/// Command-line flags from the fields and rules that the .proto files declare (proto/rules).
namespace hydroprint::flags {

/// Converts the text of a flag to the text that the field takes.
using ReadText = std::function<std::string(const google::protobuf::FieldDescriptor& field,
                                           const std::string& text)>;

/// Returns the flag of a field: "--ink-passes" for `ink_passes`.
[[nodiscard]] std::string flag_of(const google::protobuf::FieldDescriptor& field);

/// Returns whether the fields of a message in a spec have flags of their own, beside those of the
/// spec (rule `flat`).
[[nodiscard]] bool is_flat(const google::protobuf::FieldDescriptor& field);

/// Returns the fields of a spec that can have a flag, in their order: flat messages are replaced by
/// their fields. No two flat messages of a spec have the same type.
[[nodiscard]] std::vector<const google::protobuf::FieldDescriptor*> fields_of(
    const google::protobuf::Descriptor& spec);

/// Returns the message that contains one of fields_of(): the spec, or a flat message in it, which
/// becomes present.
[[nodiscard]] google::protobuf::Message& holder_of(google::protobuf::Message& spec,
                                                   const google::protobuf::FieldDescriptor& field);

/// Adds the flag of a field that is a number, text, choice, list of texts or bool, with its help
/// text. A list is separated by commas; a bool is set by the flag alone. The flag of a number whose
/// default is a word ("full") also accepts that word.
/// @param spec  contains the field (holder_of()) and receives the value; must outlive the parsing
/// @param read  converts texts; if empty, they are used unchanged
CLI::Option* add_field(CLI::App& command, google::protobuf::Message& spec,
                       const google::protobuf::FieldDescriptor& field, const ReadText& read = {});

}  // namespace hydroprint::flags
