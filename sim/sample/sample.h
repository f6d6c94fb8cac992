#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/result.h"
#include "sim/mesh/model.h"

namespace hydroprint::sample {

/// A sample that write_sample can make.
struct SampleKind {
  std::string name;
  std::string description;  ///< one line
};

/// All samples, in the order to show them in: the bodies of section 7, then a mug.
[[nodiscard]] std::vector<SampleKind> kinds();

/// A sample in memory, as reading what write_sample writes gives it but for rounding; its texture
/// is embedded. Refuses an unknown kind (kInvalidArgument).
[[nodiscard]] Result<mesh::Model> make_model(const std::string& kind);

/// Writes KIND.obj, KIND.mtl and KIND.png into `folder`, which is made if need be; the same bytes
/// every time. The meshes are closed 2-manifolds in mm with texture coordinates in [0, 1] that
/// neither overlap nor are mirrored, and stand upright, so that their feet are dipped first.
/// Refuses an unknown kind (kInvalidArgument) and a folder that cannot be written to.
[[nodiscard]] Status write_sample(const std::string& kind, const std::filesystem::path& folder);

}  // namespace hydroprint::sample
