#pragma once

#include <filesystem>

#include "hydroprint/v1/spec.pb.h"
#include "sim/base/result.h"

namespace hydroprint::paint {

/// Reads a paint (option `--paint`): the JSON of a Paint, in which a picture may be just the name
/// of its file. Names of pictures become paths, because they are relative to the file's folder.
/// Returns an error with the file and the field: kInvalidArgument for anything that check() refuses
/// and for unknown fields, kNotFound for a picture that does not exist, and the errors of
/// read_json_file().
[[nodiscard]] Result<v1::Paint> read_paint_file(const std::filesystem::path& path);

}  // namespace hydroprint::paint
