#pragma once

#include <string>

namespace hydroprint::v1 {
class ModelSummary;
}  // namespace hydroprint::v1

namespace hydroprint {

/// Describes a model to people, as `inspect` prints it: format, sizes, and how each material gets
/// its colour. Without the warnings. Each line ends with a newline.
[[nodiscard]] std::string model_summary_text(const v1::ModelSummary& summary);

}  // namespace hydroprint
