#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/process/progress.h"
#include "sim/mesh/model.h"
#include "sim/pipeline/pipeline.h"
#include "sim/pipeline/plan.h"
#include "sim/worker/common/dip.h"
#include "sim/worker/common/report.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::v1 {
enum Model : int;
enum ArtifactSet : int;
class FlowFacts;
class FlowParameters;
class MapError;
class StretchFacts;
}  // namespace hydroprint::v1

// Options and results that simulate and predict share. For inclusion in .cpp files only.
namespace hydroprint::worker {

/// Options of a dip whose film carries an image.
struct FlowOptions {
  DipOptions dip;
  double dpi = 300;
  pipeline::FilmModel film_model = pipeline::FilmModel::kSheet;
  bool inertia = false;
  int ink_passes = 1;
  std::filesystem::path ink_image;     ///< empty: no ink image
  bool map_only = false;               ///< `--artifacts map`
  std::optional<double> tolerance_mm;  ///< see pipeline::DipOptions

  /// Returns the number of passes that account for the image's own ink; 0 with an ink image, which
  /// replaces them.
  [[nodiscard]] int passes() const { return ink_image.empty() ? ink_passes : 0; }
  [[nodiscard]] bool is_sheet() const { return film_model == pipeline::FilmModel::kSheet; }
};

/// Sets the film model, the inertia and the artifact set. Fails with fail_field() if the model does
/// not support inertia.
[[nodiscard]] Status choose(FlowOptions& options, v1::Model model, bool inertia,
                            v1::ArtifactSet artifacts);

template <class Spec>
Result<FlowOptions> flow_options(const Spec& spec, const InputFolder& inputs) {
  FlowOptions out;
  HP_ASSIGN_OR_RETURN(out.dip, dip_options(spec, inputs));
  if (spec.has_dpi()) out.dpi = spec.dpi();
  if (spec.has_ink_passes()) out.ink_passes = spec.ink_passes();
  out.ink_image = inputs.path(spec.ink_image());
  HP_RETURN_IF_ERROR(choose(out, spec.model(), spec.inertia(), spec.artifacts()));
  return out;
}

/// Checks the size of the film image before the dip is computed. Fails with fail_field().
[[nodiscard]] Status check_film_image(const film::Outline& outline, double dpi);

/// Adds the texture files of the model's materials to the inputs of the run. Textures embedded in
/// the model's file are skipped.
[[nodiscard]] Status add_material_textures(const mesh::Model& model, v1::RunFacts& run);

/// Stages of a run. The weights are rough percentages of the time, measured with dips of a globe
/// and of a cow with the default options. With inertia the sheet takes three times as long.
/// @param is_planned  one dip of a plan
[[nodiscard]] std::vector<Stage> simulate_stages(const FlowOptions& options,
                                                 bool is_planned = false);
[[nodiscard]] std::vector<Stage> predict_stages(const FlowOptions& options);
[[nodiscard]] std::vector<Stage> plan_stages(const FlowOptions& options, std::size_t dips);

/// Reads the files named in the options.
[[nodiscard]] Result<pipeline::DipOptions> read_flow(const FlowOptions& options, v1::RunFacts& run,
                                                     const Context& context);

/// Sets the options of a computed dip, without the size of its film image.
/// @param X_FO  the pose of the computed dip
void set_parameters(const FlowOptions& options, const pipeline::DipOptions& dip, const Pose& X_FO,
                    v1::FlowParameters& out);
void set_stretch(const std::optional<pipeline::StretchQuantiles>& stretch, v1::StretchFacts& out);
void set_error(const pipeline::MapError& error, v1::MapError& out);
/// Sets the figures of a computed dip, and the sizes of its meshes.
void set_flow(const pipeline::Dip& dip, v1::MeshFacts& mesh, v1::FlowFacts& out);

/// Sets the findings in the report of simulate or predict.
/// @param dip  options of the computed dip
template <class Message>
void set_findings(const FlowOptions& options, const pipeline::DipOptions& dip,
                  const mesh::Model& model, const pipeline::Dip& result, Message& out) {
  set_parameters(options, dip, result.X_FO, *out.mutable_parameters());
  set_mesh(model, *out.mutable_mesh());
  set_flow(result, *out.mutable_mesh(), *out.mutable_flow());
}

/// Returns the summary of a computed dip.
[[nodiscard]] std::string flow_summary(const std::filesystem::path& dir, const v1::RunFacts& run,
                                       const v1::FlowFacts& flow);

}  // namespace hydroprint::worker
