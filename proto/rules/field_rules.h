#pragma once

#include <string>
#include <vector>

namespace google::protobuf {
class FieldDescriptor;
}

namespace hydroprint::v1 {
class FieldRules;
}

/// The rules that the .proto files declare for their fields (hydroprint/v1/field_rules.proto).
namespace hydroprint::rules {

/// Returns the rules of a field; null if it has none.
[[nodiscard]] const v1::FieldRules* rules_of(const google::protobuf::FieldDescriptor& field);

/// Returns whether a finite value lies in the range of the rules; true if they declare no range.
[[nodiscard]] bool is_in_range(const v1::FieldRules& rules, double value);

/// Returns "from 20 to 2400 dots per inch", "above 0 and at most 4"; empty if there is no range.
[[nodiscard]] std::string range_text(const google::protobuf::FieldDescriptor& field);

/// Returns the allowed values of a text or enum in the notation for users: "sheet", "stokes". Empty
/// if they are not restricted.
[[nodiscard]] std::vector<std::string> choices(const google::protobuf::FieldDescriptor& field);

/// Returns the default in the notation for users: "300", "sheet"; empty if none is declared.
[[nodiscard]] std::string default_text(const google::protobuf::FieldDescriptor& field);

/// Returns range, choices and default for help texts: "from 20 to 2400 dots per inch; default 300".
/// Empty if the field has none of them.
[[nodiscard]] std::string help_text(const google::protobuf::FieldDescriptor& field);

/// Help text of the field's command-line flag: its `flag_help`, otherwise the first sentence of its
/// comment. Range, choices and default follow in parentheses; a default that the comment states
/// ("Default: ...") replaces the declared one. If the comment begins with "See ", the comment of
/// the field that `like` names is used instead.
[[nodiscard]] std::string flag_help(const google::protobuf::FieldDescriptor& field);

/// Returns the name of the field's command-line flag without the leading "--":
/// "dip-speed-mm-per-s".
[[nodiscard]] std::string flag_of(const google::protobuf::FieldDescriptor& field);

}  // namespace hydroprint::rules
