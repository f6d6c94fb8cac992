#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::client {

/// A file that a model refers to.
struct Reference {
  std::string name;            ///< relative to the model's folder, '/' between its parts
  std::filesystem::path path;  ///< where it is
};

/// What has to travel with a model so that it is read elsewhere as it is here.
struct References {
  std::vector<Reference> files;    ///< in the order of their mention, each once
  std::vector<std::string> notes;  ///< for people: what is referred to but cannot be sent, and why
};

/// Follows the names in an OBJ (its material libraries and their textures), a glTF or GLB (buffers
/// and images), or the TextureFile comments of a PLY. Any other file refers to nothing, and what is
/// broken in the model is left to the worker to refuse. Names that lead out of the model's folder
/// are not followed.
/// @return errors of reading the model file itself
[[nodiscard]] Result<References> find_references(const std::filesystem::path& model);

}  // namespace hydroprint::client
