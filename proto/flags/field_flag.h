#pragma once

#include <google/protobuf/message.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

/// Command-line flags from what the .proto files declare (proto/rules).
namespace hydroprint::flags {

/// Converts the text of a flag to the text that the field takes.
using ReadText = std::function<std::string(const google::protobuf::FieldDescriptor& field,
                                           const std::string& text)>;

/// "--ink-passes" for the field `ink_passes`.
[[nodiscard]] std::string flag_of(const google::protobuf::FieldDescriptor& field);

/// Adds the flag of a field that is a number, text, choice, list of texts or bool, with its help
/// text. A list is separated by commas; a bool is set by the flag alone. A flag whose default is a
/// word ("full") accepts this word, too.
/// @param spec  receives the value; must outlive the parsing
/// @param read  applied to texts; empty: taken as they are
CLI::Option* add_field(CLI::App& command, google::protobuf::Message& spec,
                       const google::protobuf::FieldDescriptor& field, const ReadText& read = {});

}  // namespace hydroprint::flags
