#include "sim/worker/artifacts.h"

#include <functional>
#include <utility>

#include "sim/image/image_file.h"
#include "sim/worker/surface_ply.h"

namespace hydroprint::worker {
namespace {

/// A file to write: its name and how.
using Task = std::pair<std::string, std::function<Status(const std::filesystem::path&)>>;

Result<std::vector<std::string>> write_all(const std::filesystem::path& folder,
                                           const std::vector<Task>& tasks, const Context& context) {
  std::vector<std::string> names;
  for (const auto& [name, write] : tasks) {
    context.progress("writing",
                     static_cast<double>(names.size()) / static_cast<double>(tasks.size() + 1));
    HP_RETURN_IF_ERROR(check_cancelled(context));
    HP_RETURN_IF_ERROR(write(folder / name));
    names.push_back(name);
  }
  return names;
}

}  // namespace

Result<std::vector<std::string>> write_artifacts(const std::filesystem::path& folder,
                                                 const pipeline::Simulation& simulation, double dpi,
                                                 const Context& context) {
  using Path = std::filesystem::path;
  const pipeline::Dip& dip = simulation.dip;
  std::vector<Task> tasks = {{"surface_map.ply", [&](const Path& path) {
                                return write_surface_map(path, dip.surface, dip.map.surface);
                              }}};
  if (simulation.images) {
    const pipeline::SimulatedImages& images = *simulation.images;
    tasks.emplace_back("film.png", [&images, dpi](const Path& path) {
      return image::write_png(path, images.film, dpi);
    });
  }
  return write_all(folder, tasks, context);
}

}  // namespace hydroprint::worker
