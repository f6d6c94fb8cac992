#include "sim/pipeline/read_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "sim/base/run_beside.h"
#include "sim/image/io/image_file.h"
#include "sim/mesh/read/read_model.h"

namespace hydroprint::pipeline {
namespace {

/// Models up to this size leave memory for the image libraries to load in parallel.
constexpr std::uintmax_t kSmallModel_bytes = std::uintmax_t{16} << 20;

bool is_small(const std::filesystem::path& file) {
  std::error_code unknown;
  const auto bytes = std::filesystem::file_size(file, unknown);
  return !unknown && bytes <= kSmallModel_bytes;
}

/// Reads the model and, if images are needed, loads the image libraries. That takes as long as
/// reading most models, so it happens at the same time. Before a large model, the libraries are
/// loaded first, because they end the program if there is no memory for them. The calling thread
/// always loads them, because LeakSanitizer reports libraries whose loading thread has ended.
Result<mesh::Model> read_model(const ModelInput& input, const Context& context) {
  const auto read = [&](const Context& reading) {
    return mesh::read_model(input.mesh, input.scale, reading);
  };
  if (!input.images && !input.has_paint) return read(context);
  const auto load = [](const Context&) -> Result<bool> {
    image::load_image_libraries();
    return true;
  };
  if (!is_small(input.mesh)) {
    (void)load(context);
    return read(context);
  }
  HP_ASSIGN_OR_RETURN(auto both, run_beside(context, read, load));
  return std::move(both.first);
}

/// Returns up to three phrases, and how many more there are.
std::string list_of(const std::vector<std::string>& phrases) {
  constexpr std::size_t kMost = 3;
  std::string out;
  for (std::size_t i = 0; i < std::min(phrases.size(), kMost); ++i)
    out += (i == 0 ? "" : "; ") + phrases[i];
  if (phrases.size() > kMost) out += fmt::format("; and {} more", phrases.size() - kMost);
  return out;
}

std::string no_colour_text(const mesh::Model& model) {
  std::string out =
      model.path.string() + ": has no colour that was understood, so the film would stay blank. ";
  if (!model.not_understood.empty())
    out += "Found, but not understood: " + list_of(model.not_understood) + ". ";
  return out +
         "Name a picture, with a projection for how it lands, or a paint, or give the model "
         "colours "
         "or a texture in a 3D editor";
}

}  // namespace

image::PaintSource paint_source(const std::optional<image::PaintSource>& paint,
                                const std::optional<std::filesystem::path>& texture) {
  if (paint) return *paint;
  image::PaintSource out;
  image::Layer& layer = out.layers.emplace_back();
  if (texture) {
    layer.name = texture->filename().string();
    layer.picture = *texture;
  } else {
    layer.projection = image::Projection::kUv;
  }
  return out;
}

bool needs_own_colours(const image::PaintSource& paint) {
  return std::ranges::any_of(paint.layers, [](const image::Layer& layer) {
    return layer.picture.empty() && !layer.colour;
  });
}

Result<image::LayeredPaint> read_any_paint(const mesh::Model& model,
                                           const image::PaintSource& source,
                                           const std::optional<Pose>& X_FO,
                                           const Context& context) {
  const Eigen::Matrix3d R_FO = X_FO.value_or(Pose::Identity()).linear();
  return image::load_layers(model, source, R_FO, context);
}

Result<image::LayeredPaint> read_paint(const mesh::Model& model, const image::PaintSource& source,
                                       const std::optional<Pose>& X_FO, const Context& context) {
  HP_ASSIGN_OR_RETURN(image::LayeredPaint paint, read_any_paint(model, source, X_FO, context));
  if (paint.has_colour()) return paint;
  if (needs_own_colours(source)) return fail(Code::kInvalidArgument, no_colour_text(model));
  return fail(Code::kInvalidArgument,
              "the paint is plain white, so the film would stay blank. Give it a picture or a "
              "colour");
}

Status check_materials(const mesh::Model& model) {
  for (const Warning& warning : model.warnings) {
    if (warning.code != WarningCode::MATERIAL_FILE_MISSING &&
        warning.code != WarningCode::MATERIAL_MISSING)
      continue;
    return fail(
        Code::kNotFound,
        words_of(warning.where) + ": " + warning.message +
            ". Put the complete material file into the model's folder, or specify a picture");
  }
  return {};
}

Result<mesh::Model> read_inputs(const ModelInput& input, const Context& context) {
  context.progress("reading", 0);
  HP_ASSIGN_OR_RETURN(mesh::Model model, read_model(input, context));
  if (input.images && !input.has_paint) HP_RETURN_IF_ERROR(check_materials(model));
  return model;
}

}  // namespace hydroprint::pipeline
