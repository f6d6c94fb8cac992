#include "sim/worker/artifacts.h"

#include <functional>
#include <utility>

#include "sim/image/image_file.h"
#include "sim/worker/surface_ply.h"

namespace hydroprint::worker {
namespace {

using Path = std::filesystem::path;

/// A file to write: its name and how.
using Task = std::pair<std::string, std::function<Status(const Path&)>>;

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

Task surface_map(const pipeline::Dip& dip) {
  return {"surface_map.ply", [&dip](const Path& path) {
            return write_surface_map(path, dip.surface, dip.map.surface);
          }};
}

Task picture(const std::string& name, const image::RgbImage& image, double dpi,
             const Context& context) {
  return {name, [&image, dpi, &context](const Path& path) {
            return image::write_png(path, image, dpi, context);
          }};
}

}  // namespace

Result<std::vector<std::string>> write_artifacts(const std::filesystem::path& folder,
                                                 const pipeline::Simulation& simulation, double dpi,
                                                 const Context& context) {
  std::vector<Task> tasks = {surface_map(simulation.dip)};
  if (simulation.images) {
    const pipeline::SimulatedImages& images = *simulation.images;
    tasks.push_back(picture("film.png", images.film, dpi, context));
    tasks.emplace_back("film_map.exr", [&images](const Path& path) {
      return image::write_film_map_exr(path, images.film_map);
    });
    tasks.push_back(picture("stretch.png", images.stretch, image::kScreenDpi, context));
    if (images.wrinkles)
      tasks.push_back(picture("wrinkles.png", *images.wrinkles, image::kScreenDpi, context));
    tasks.push_back(picture("predicted.png", images.predicted, image::kScreenDpi, context));
  }
  return write_all(folder, tasks, context);
}

Result<std::vector<std::string>> write_artifacts(const std::filesystem::path& folder,
                                                 const pipeline::Prediction& prediction,
                                                 const Context& context) {
  if (!prediction.images) return write_all(folder, {surface_map(prediction.dip)}, context);
  const pipeline::PredictedImages& images = *prediction.images;
  std::vector<Task> tasks = {{"landed.ply", [&](const Path& path) {
                                return write_landed(path, prediction.dip.surface, images.landed);
                              }}};
  if (images.texture) {
    tasks.emplace_back("landed.png", [&images](const Path& path) {
      return image::write_png_rgba(path, images.texture->width, images.texture->height,
                                   images.texture->rgba);
    });
  }
  tasks.push_back(picture("predicted.png", images.picture, image::kScreenDpi, context));
  return write_all(folder, tasks, context);
}

}  // namespace hydroprint::worker
