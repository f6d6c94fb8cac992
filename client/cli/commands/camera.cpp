#include "client/camera.h"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "sim/base/artifact_file.h"

namespace hydroprint::cli {
namespace {

void show(const v1::DepthPicture& seen) {
  std::printf("%s: %.0f to %.0f mm, %.0f %% of the picture measured, %.1f s ago\n",
              printable(seen.camera()).c_str(), seen.nearest_mm(), seen.farthest_mm(),
              100 * seen.measured_share(), seen.age_s());
}

Status look(Program& program, const std::filesystem::path& out) {
  HP_ASSIGN_OR_RETURN(const v1::DepthPicture seen, client::depth_picture(program.daemon()));
  if (out == "-") {
    std::cout << seen.png() << std::flush;
    return {};
  }
  if (!out.empty()) {
    HP_RETURN_IF_ERROR(image::write_artifact(out, std::string_view(seen.png())));
  }
  if (program.json()) {
    print(seen);
  } else {
    show(seen);
  }
  return {};
}

}  // namespace

void add_camera(CLI::App& app, Program& program) {
  auto out = std::make_shared<std::filesystem::path>();
  CLI::App* command =
      app.add_subcommand("camera", "Show the current picture of the daemon's depth camera");
  command
      ->add_option("--out", *out,
                   "Write the picture to a PNG file, or - for standard output; nearer is brighter")
      ->type_name("FILE");
  command->footer(
      "The camera runs while pictures are requested, and for 10 s after that. A capture has "
      "priority.\n\n"
      "Example:\n"
      "  hydroprint camera --out depth.png");
  program.on(*command, [&program, out] { return look(program, *out); });
}

}  // namespace hydroprint::cli
