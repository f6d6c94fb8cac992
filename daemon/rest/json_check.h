#pragma once

#include <string_view>

#include "sim/base/result.h"

namespace google::protobuf {
class Descriptor;
}  // namespace google::protobuf

namespace hydroprint::rest {

/// Rejects invalid text that protobuf's parser would accept, and text that this parser would take
/// too long to parse; see read_json(). Time and memory are proportional to the length of the text.
/// @param message  type of the message that the text represents
/// @param what     the text, for errors
[[nodiscard]] Status check_json(std::string_view text, const google::protobuf::Descriptor& message,
                                std::string_view what);

}  // namespace hydroprint::rest
