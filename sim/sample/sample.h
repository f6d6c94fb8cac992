#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/result.h"
#include "sim/mesh/model.h"

namespace hydroprint::sample {

/// A sample that write_sample() can write.
struct SampleKind {
  std::string name;
  std::string description;  ///< one line
};

/// Returns all samples, in display order.
[[nodiscard]] std::vector<SampleKind> kinds();

/// Creates a sample in memory. It equals the model read from the files of write_sample(), except
/// for rounding, and its texture is embedded. Errors: kInvalidArgument for an unknown kind.
[[nodiscard]] Result<mesh::Model> make_model(const std::string& kind);

/// Writes KIND.obj, KIND.mtl and KIND.png into `folder`, which is created if necessary. Every call
/// writes identical files. The meshes are closed 2-manifolds in mm. Their texture coordinates lie
/// in [0, 1] and neither overlap nor are mirrored. They stand upright, so that their feet are
/// dipped first. Fails for an unknown kind (kInvalidArgument) or a folder that is not writable.
[[nodiscard]] Status write_sample(const std::string& kind, const std::filesystem::path& folder);

}  // namespace hydroprint::sample
