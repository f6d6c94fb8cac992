#include "sim/sample/sample.h"

#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"

namespace hydroprint::cli {
namespace {

struct SampleOptions {
  std::string kind;
  std::string out = ".";
};

Status make(const Program& program, const SampleOptions& options) {
  HP_RETURN_IF_ERROR(sample::write_sample(options.kind, options.out));
  const std::filesystem::path folder(options.out);
  Json files = Json::array();
  for (const char* ending : {".obj", ".mtl", ".png"}) {
    files.push_back((folder / (options.kind + ending)).string());
    if (!program.json()) std::cout << files.back().get<std::string>() << "\n";
  }
  if (program.json()) print({{"files", files}});
  return {};
}

}  // namespace

void add_sample(CLI::App& app, Program& program) {
  auto options = std::make_shared<SampleOptions>();
  CLI::App* command =
      app.add_subcommand("sample", "Create a sample: a mesh in mm with its texture");
  std::vector<std::string> names;
  std::string footer = "Kinds:\n";
  for (const sample::SampleKind& kind : sample::kinds()) {
    names.push_back(kind.name);
    footer += fmt::format("  {:<9} {}\n", kind.name, kind.description);
  }
  command->add_option("kind", options->kind, "The sample")
      ->type_name("KIND")
      ->required()
      ->check(CLI::IsMember(names));
  command->add_option("--out", options->out, "Destination folder")
      ->type_name("DIR")
      ->capture_default_str();
  command->footer(footer + "\nExample:\n  hydroprint sample globe --out sample");
  program.on(*command, [&program, options] { return make(program, *options); });
}

}  // namespace hydroprint::cli
