#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::client {

/// A file that a model refers to.
struct Reference {
  std::string name;            ///< relative to the model's folder, separated by '/'
  std::filesystem::path path;  ///< its path on this machine
};

/// The files that must be sent together with a model.
struct References {
  std::vector<Reference> files;    ///< in order of first mention, without duplicates
  std::vector<std::string> notes;  ///< references that cannot be sent, with the reason
};

/// Finds the files that a model refers to: material libraries and their textures (OBJ), buffers and
/// images (glTF, GLB), TextureFile comments (PLY). Other formats have no references. Errors in the
/// model are left for the worker to report. Names that lead outside the model's folder are not
/// followed.
/// @return errors of reading the model file itself
[[nodiscard]] Result<References> find_references(const std::filesystem::path& model);

}  // namespace hydroprint::client
