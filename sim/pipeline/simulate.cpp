#include "sim/pipeline/simulate.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <future>
#include <optional>
#include <system_error>
#include <utility>

#include "sim/image/film_image.h"
#include "sim/image/film_texture.h"
#include "sim/image/image_file.h"
#include "sim/image/paint.h"
#include "sim/image/pictures.h"
#include "sim/mesh/read_model.h"
#include "sim/pipeline/ink_passes.h"
#include "sim/pipeline/start.h"

namespace hydroprint::pipeline {
namespace {

constexpr double kFilmMapCell_mm = 1;  ///< contract: film_map.exr

/// What would leave faces white though the model means them to have a colour.
Status check_materials(const mesh::Model& model) {
  for (const Warning& warning : model.warnings) {
    if (warning.code != "material_file_missing" && warning.code != "material_missing") continue;
    return fail(Code::kNotFound, warning.where + ": " + warning.message +
                                     ". Put it beside the model or give a texture");
  }
  return {};
}

/// How to do something beside the caller's work: later, if there is but one thread.
std::launch beside(const Context& context) {
  return context.threads > 1 ? std::launch::async : std::launch::deferred;
}

/// Models up to here leave memory for whatever else is done meanwhile.
constexpr std::uintmax_t kSmallModel_bytes = std::uintmax_t{16} << 20;

/// The image libraries take as long to load as most models to read. They come before a large one,
/// as they end the program where they find no memory; and are not loaded by another thread, as
/// LeakSanitizer stumbles over libraries whose loader has ended.
Result<mesh::Model> read_model(const SimulateOptions& options, const Context& context) {
  std::error_code unknown;
  const bool is_small = std::filesystem::file_size(options.mesh, unknown) <= kSmallModel_bytes;
  auto model = std::async(is_small && !unknown ? beside(context) : std::launch::deferred,
                          [&] { return mesh::read_model(options.mesh, options.scale, context); });
  if (options.images || options.texture) image::load_image_libraries();
  return model.get();
}

/// What a simulation begins with.
struct Beginning {
  Start start;
  std::optional<image::Paint> paint;  ///< if anybody asks for its colours
};

/// Paint and flow do not need each other: the one is read while the other is solved. Where the
/// paint cannot be read the flow is given up.
Result<Beginning> begin(const mesh::Model& model, const SimulateOptions& options,
                        const DipOptions& dip_options, bool is_painted, const Context& context) {
  Beginning out;
  std::atomic<bool> in_vain = false;
  Context flowing = context;
  flowing.cancelled = [&] { return in_vain || context.is_cancelled(); };
  auto started = std::async(beside(context), [&] { return start(model, dip_options, flowing); });
  if (is_painted) {
    Context reading = context;
    reading.report = nullptr;  // the flow tells how far it is
    auto paint = image::load_paint(model, options.texture, reading);
    in_vain = !paint;
    HP_ASSIGN_OR_RETURN(out.paint, std::move(paint));
  }
  HP_ASSIGN_OR_RETURN(out.start, started.get());
  return out;
}

Result<SimulatedImages> draw(const Dip& dip, const image::Paint& paint,
                             const SimulateOptions& options, const Context& context) {
  SimulatedImages out;
  const film::Outline& film = options.dip.outline;
  HP_ASSIGN_OR_RETURN(
      out.film, image::film_image(dip.surface, dip.map.tiles, paint, film, options.dpi, context));
  context.progress("pictures", 0);
  HP_ASSIGN_OR_RETURN(out.film_map,
                      image::film_map(dip.surface, dip.map, film, kFilmMapCell_mm, context));
  context.progress("pictures", 0.3);
  HP_ASSIGN_OR_RETURN(const image::ObjectViews views,
                      image::find_views(dip.surface, dip.X_FO, dip.map.tiles, context));
  HP_ASSIGN_OR_RETURN(out.stretch, image::stretch_picture(views, dip.map.surface, context));
  if (dip.figures.wrinkled_share > 0) {
    HP_ASSIGN_OR_RETURN(out.wrinkles, image::wrinkle_picture(views, dip.map.surface, context));
  }
  context.progress("pictures", 0.6);
  HP_ASSIGN_OR_RETURN(
      const image::FilmTexture printed,
      image::FilmTexture::from_image(out.film, film, image::kPictureFilmSide_px, context));
  HP_ASSIGN_OR_RETURN(out.predicted, image::predicted_picture(views, printed, context));
  return out;
}

}  // namespace

Result<Simulation> simulate(const SimulateOptions& options, const Context& context) {
  Simulation out;
  context.progress("reading", 0);
  const int passes = options.dip.film_model == FilmModel::kSheet ? options.ink_passes : 0;
  HP_ASSIGN_OR_RETURN(out.model, read_model(options, context));
  DipOptions dip_options = options.dip;
  dip_options.map.make_tiles = options.images;
  dip_options.map = flow::for_resolution(dip_options.map, options.dpi);
  if (options.images && !options.texture) HP_RETURN_IF_ERROR(check_materials(out.model));
  HP_ASSIGN_OR_RETURN(
      auto begun, begin(out.model, options, dip_options, options.images || passes > 0, context));
  auto& [first, paint] = begun;
  if (passes > 0 && paint->has_colour()) {
    HP_ASSIGN_OR_RETURN(out.dip, dip_inked(out.model, std::move(first), *paint, passes, options.dpi,
                                           dip_options, context));
  } else {
    HP_ASSIGN_OR_RETURN(out.dip, dip(out.model, std::move(first), dip_options, context));
  }
  if (options.images) {
    HP_ASSIGN_OR_RETURN(out.images, draw(out.dip, *paint, options, context));
  }
  out.warnings = out.dip.warnings;
  if (paint) {
    out.warnings.insert(out.warnings.end(), paint->warnings().begin(), paint->warnings().end());
  }
  return out;
}

}  // namespace hydroprint::pipeline
