#include "sim/pipeline/read_inputs.h"

#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

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

/// Returns an error for a model whose faces would be white because the files that define their
/// colours are missing.
Status check_materials(const mesh::Model& model) {
  for (const Warning& warning : model.warnings) {
    if (warning.code != "material_file_missing" && warning.code != "material_missing") continue;
    return fail(
        Code::kNotFound,
        warning.where + ": " + warning.message +
            ". Put the complete material file into the model's folder, or specify a texture");
  }
  return {};
}

/// Reads the model and, if images are needed, loads the image libraries. That takes as long as
/// reading most models, so it happens at the same time. Before a large model, the libraries are
/// loaded first, because they end the program if there is no memory for them. The calling thread
/// always loads them, because LeakSanitizer reports libraries whose loading thread has ended.
Result<mesh::Model> read_model(const ModelInput& input, const Context& context) {
  const auto read = [&](const Context& reading) {
    return mesh::read_model(input.mesh, input.scale, reading);
  };
  if (!input.images && !input.has_texture) return read(context);
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

}  // namespace

Result<mesh::Model> read_inputs(const ModelInput& input, const Context& context) {
  context.progress("reading", 0);
  HP_ASSIGN_OR_RETURN(mesh::Model model, read_model(input, context));
  if (input.images && !input.has_texture) HP_RETURN_IF_ERROR(check_materials(model));
  return model;
}

}  // namespace hydroprint::pipeline
