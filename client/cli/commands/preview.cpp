#include "client/preview.h"

#include <cstdio>
#include <memory>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/job_io/submit_flags.h"
#include "client/cli/program/program.h"
#include "proto/warning_message.h"

namespace hydroprint::cli {
namespace {

void show(const v1::Preview& preview) {
  std::printf(
      "film reaches %.0f %% of the surface at a depth of %.1f mm; stretch is below %.2f for half "
      "of that, below %.2f for 95 %%\n",
      100 * preview.coverage(), preview.depth_mm(), preview.stretch_p50(), preview.stretch_p95());
  for (const v1::Warning& warning : preview.warnings())
    std::fprintf(stderr, "hydroprint: warning: %s\n", hydroprint::text_of(warning).c_str());
}

Status preview(Program& program, const SubmitOptions& options) {
  Inputs inputs(program.daemon());
  HP_ASSIGN_OR_RETURN(const v1::Job job, upload_inputs(inputs, options));
  HP_ASSIGN_OR_RETURN(const v1::Preview answer,
                      client::compute_preview(program.daemon(), job.simulate()));
  if (program.json()) {
    print(answer);
  } else {
    show(answer);
  }
  return {};
}

}  // namespace

void add_preview(CLI::App& app, Program& program) {
  auto options = std::make_shared<SubmitOptions>();
  options->job.mutable_simulate();
  CLI::App* command =
      app.add_subcommand("preview", "Predict a dip roughly, in a fraction of a second");
  add_spec_flags(*command, *options,
                 {"mesh", "scale", "pose", "film", "profile", "depth_mm", "dip_speed_mm_per_s"});
  command->footer(
      "Uses Stokes flow on a coarse film; creates no job. The daemon keeps the mesh in memory for "
      "the next preview.\n\n"
      "Example:\n"
      "  hydroprint preview --mesh mug.obj --scale 10 --pose pose.json --film A3");
  program.on(*command, [&program, options] { return preview(program, *options); });
}

}  // namespace hydroprint::cli
