#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/job_io/field_help.h"
#include "client/cli/job_io/inputs.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/preview.h"
#include "proto/model_summary_text.h"
#include "proto/warning_message.h"
#include "sim/base/artifact_file.h"

namespace hydroprint::cli {
namespace {

struct InspectOptions {
  std::vector<std::string> files;
  v1::InspectSpec spec;  ///< without files
  std::string glb;       ///< file for the display; empty: none
};

void show(const std::string& file, const v1::ModelSummary& summary) {
  std::printf("%s: %s", printable(file).c_str(), model_summary_text(summary).c_str());
  for (const v1::Warning& warning : summary.warnings())
    std::fprintf(stderr, "hydroprint: warning: %s\n", hydroprint::text_of(warning).c_str());
}

Status inspect_file(Program& program, const InspectOptions& options, const std::string& file) {
  v1::InspectSpec spec = options.spec;
  Inputs inputs(program.daemon());
  HP_RETURN_IF_ERROR(inputs.add_model(file, spec));
  HP_ASSIGN_OR_RETURN(const v1::DisplayModel model, client::read_model(program.daemon(), spec));
  if (!options.glb.empty())
    HP_RETURN_IF_ERROR(image::write_artifact(options.glb, std::string_view(model.glb())));
  if (program.json()) {
    print(model.summary());
  } else {
    show(file, model.summary());
  }
  return {};
}

Status inspect(Program& program, const InspectOptions& options) {
  if (!options.glb.empty() && options.files.size() > 1)
    return fail(Code::kInvalidArgument, "--glb: needs a single model; give one FILE");
  for (const std::string& file : options.files)
    HP_RETURN_IF_ERROR(inspect_file(program, options, file));
  return {};
}

}  // namespace

void add_inspect(CLI::App& app, Program& program) {
  auto options = std::make_shared<InspectOptions>();
  CLI::App* command = app.add_subcommand(
      "inspect", "Show how models are understood: sizes, materials, colours, warnings");
  command
      ->add_option(
          "files", options->files,
          "Models: OBJ, STL, PLY, glTF or GLB; the files that they name are found beside them")
      ->type_name("FILES")
      ->required();
  command
      ->add_option_function<double>(
          "--scale", [options](double scale) { options->spec.set_scale(scale); },
          field_help("InspectSpec.scale"))
      ->type_name("NUMBER")
      ->check(field_range("InspectSpec.scale"));
  command->add_flag_callback(
      "--shape-only", [options] { options->spec.set_shape_only(true); },
      "Leave the model's own colours out; then files that define them may be missing");
  command->add_option("--glb", options->glb, "Also write the model as it is shown, as binary glTF")
      ->type_name("FILE.glb");
  command->footer(
      "With --json, prints a message for each model, on a line of its own.\n\n"
      "Examples:\n"
      "  hydroprint inspect mug.obj --scale 10\n"
      "  hydroprint inspect spot.obj --glb shown.glb");
  program.on(*command, [&program, options] { return inspect(program, *options); });
}

}  // namespace hydroprint::cli
