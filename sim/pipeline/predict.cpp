#include "sim/pipeline/predict.h"

#include "sim/image/figures/pictures.h"
#include "sim/image/film/film_texture.h"
#include "sim/ink/ink_of.h"
#include "sim/mesh/read/read_model.h"
#include "sim/pipeline/dip.h"

namespace hydroprint::pipeline {
namespace {

/// Side of the predicted texture, in texels. The texture has about half as many pixels as a film
/// image on A4 at 300 dpi.
constexpr int kTextureSide_px = 2048;

Result<PredictedImages> draw(const mesh::Model& model, const Dip& dip,
                             const image::FilmTexture& film, const Context& context) {
  PredictedImages out;
  context.progress("pictures", 0);
  out.landed = image::landed_colours(dip.map.surface, film);
  if (!model.corner_uvs.empty()) {
    HP_ASSIGN_OR_RETURN(
        out.texture, image::landed_texture(model, dip.surface, dip.map.tiles, film, kTextureSide_px,
                                           kTextureSide_px, context));
  }
  context.progress("pictures", 0.5);
  HP_ASSIGN_OR_RETURN(const auto views,
                      image::find_views(dip.surface, dip.X_FO, dip.map.tiles, context));
  HP_ASSIGN_OR_RETURN(out.picture, image::predicted_picture(views, film, context));
  return out;
}

}  // namespace

Result<Prediction> predict(const PredictOptions& options, const Context& context) {
  Prediction out;
  context.progress("reading", 0);
  HP_ASSIGN_OR_RETURN(const image::FilmTexture film,
                      image::FilmTexture::read(options.film_image, options.dip.outline, context));
  HP_ASSIGN_OR_RETURN(out.model, mesh::read_model(options.mesh, options.scale, context));
  DipOptions dip_options = options.dip;
  dip_options.map.make_tiles = options.images;
  if (dip_options.film_model == FilmModel::kSheet && options.ink_passes > 0) {
    HP_ASSIGN_OR_RETURN(dip_options.ink,
                        ink::read_ink_image(options.film_image, dip_options.outline,
                                            {dip_options.profile.ink_icc_profile}, context));
  }
  HP_ASSIGN_OR_RETURN(out.dip, dip(out.model, dip_options, context));
  out.warnings = out.dip.warnings;
  if (options.images) {
    HP_ASSIGN_OR_RETURN(out.images, draw(out.model, out.dip, film, context));
  }
  return out;
}

}  // namespace hydroprint::pipeline
