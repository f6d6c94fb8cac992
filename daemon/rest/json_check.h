#pragma once

#include <string_view>

#include "sim/base/result.h"

namespace google::protobuf {
class Descriptor;
}  // namespace google::protobuf

namespace hydroprint::rest {

/// Refuses, before protobuf's parser sees it, what that one lets pass or takes too long for: see
/// read_json(). Takes time and memory in proportion to the text.
/// @param message  what the text is to be read as
[[nodiscard]] Status check_json(std::string_view text, const google::protobuf::Descriptor& message);

}  // namespace hydroprint::rest
