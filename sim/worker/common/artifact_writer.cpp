#include "sim/worker/common/artifact_writer.h"

#include "sim/image/io/image_file.h"
#include "sim/worker/common/surface_ply.h"

namespace hydroprint::worker {

using Path = std::filesystem::path;

FileTask surface_map_file(const pipeline::Dip& dip) {
  return {"surface_map.ply", [&dip](const Path& path) {
            return write_surface_map(path, dip.surface, dip.map.surface, dip.face_flags);
          }};
}

FileTask png_file(const std::string& name, const image::RgbImage& image, double dpi,
                  const Context& context) {
  return {name, [&image, dpi, &context](const Path& path) {
            return image::write_png(path, image, dpi, context);
          }};
}

Result<std::vector<std::string>> write_files(const Path& folder, const std::vector<FileTask>& files,
                                             const Context& context) {
  std::vector<std::string> names;
  for (const auto& [name, write] : files) {
    context.progress("writing",
                     static_cast<double>(names.size()) / static_cast<double>(files.size() + 1));
    HP_RETURN_IF_ERROR(check_cancelled(context));
    HP_RETURN_IF_ERROR(write(folder / name));
    names.push_back(name);
  }
  return names;
}

}  // namespace hydroprint::worker
