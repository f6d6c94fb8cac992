#pragma once

#include <google/protobuf/repeated_field.h>

#include "hydroprint/v1/warning.pb.h"
#include "sim/base/result.h"

// Warnings as messages of the API. For inclusion in .cpp files only.
namespace hydroprint {

/// Returns the message; text that is not UTF-8 is repaired.
[[nodiscard]] v1::Warning to_message(const Warning& warning);

/// Adds the warnings to a field of a message.
void add_warnings(const Warnings& warnings,
                  google::protobuf::RepeatedPtrField<v1::Warning>& messages);

/// Returns the warning of a message.
[[nodiscard]] Warning to_warning(const v1::Warning& message);

/// Returns a warning on one line: "the film tears ... (dip 2)".
[[nodiscard]] std::string text_of(const v1::Warning& warning);

}  // namespace hydroprint
