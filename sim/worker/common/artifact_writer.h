#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/io/rgb_image.h"
#include "sim/pipeline/pipeline.h"

namespace hydroprint::worker {

/// A file to write: its name, and a function that writes it to a path.
using FileTask = std::pair<std::string, std::function<Status(const std::filesystem::path&)>>;

/// Returns a task that writes surface_map.ply. The dip must outlive the task.
[[nodiscard]] FileTask surface_map_file(const pipeline::Dip& dip);
/// Returns a task that writes a PNG. The image and the context must outlive the task.
[[nodiscard]] FileTask png_file(const std::string& name, const image::RgbImage& image, double dpi,
                                const Context& context);

/// Writes files into a folder and reports the progress of the stage `writing`. Returns the errors
/// of image::write_artifact().
/// @return the names of the files
[[nodiscard]] Result<std::vector<std::string>> write_files(const std::filesystem::path& folder,
                                                           const std::vector<FileTask>& files,
                                                           const Context& context);

}  // namespace hydroprint::worker
