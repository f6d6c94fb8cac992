#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sim/base/error_reason.h"

namespace google::protobuf {
class Message;
}

namespace hydroprint::rules {

/// A field that breaks its rules.
struct Violation {
  std::string field;    ///< path of the field: "simulate.dpi", "simulate.extra_files[1].name"
  std::string problem;  ///< "must be from 20 to 2400 dots per inch"
  ErrorReason reason;

  bool operator==(const Violation&) const = default;
};

/// Checks of text formats, by the name of the format (FieldRules.format). Each returns the problem
/// with a text, or an empty string. Formats that are not listed are not checked.
using FormatChecks = std::map<std::string, std::function<std::string(const std::string& text)>>;

/// Checks a message and its nested messages. Read-only fields are ignored.
/// @param path  path of `message`, the prefix of Violation::field; empty for the root
/// @return all violations, at most one for each field, in declaration order
[[nodiscard]] std::vector<Violation> check(const google::protobuf::Message& message,
                                           const FormatChecks& formats = {},
                                           const std::string& path = {});

}  // namespace hydroprint::rules
