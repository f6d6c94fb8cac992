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

/// The files that must be sent along with a model.
struct References {
  std::vector<Reference> files;    ///< in order of first mention, without duplicates
  std::vector<std::string> notes;  ///< for people: references that cannot be sent, with the reason
};

/// Follows the names in an OBJ (material libraries and their textures), a glTF or GLB (buffers and
/// images), or the TextureFile comments of a PLY. Other formats have no references, and a broken
/// model is left for the worker to report. Names that lead outside the model's folder are not
/// followed.
/// @return errors of reading the model file itself
[[nodiscard]] Result<References> find_references(const std::filesystem::path& model);

}  // namespace hydroprint::client
