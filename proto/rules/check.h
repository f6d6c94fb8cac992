#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace google::protobuf {
class Message;
}

namespace hydroprint::rules {

/// A violation of a field's rules.
struct Violation {
  std::string field;    ///< its path: "simulate.dpi", "simulate.extra_files[1].name"
  std::string problem;  ///< "must be from 20 to 2400 dots per inch"
  std::string reason;   ///< name of an ErrorReason

  bool operator==(const Violation&) const = default;
};

/// Checks of notations, by name (FieldRules.format). A check returns a description of the problem,
/// or an empty string. Notations without an entry are not checked.
using FormatChecks = std::map<std::string, std::function<std::string(const std::string& text)>>;

/// Checks a message and its nested messages. Read-only fields are ignored.
/// @param path  path of the message itself, for Violation::field; empty at the root
/// @return all violations in declaration order, at most one for each field
[[nodiscard]] std::vector<Violation> check(const google::protobuf::Message& message,
                                           const FormatChecks& formats = {},
                                           const std::string& path = {});

}  // namespace hydroprint::rules
