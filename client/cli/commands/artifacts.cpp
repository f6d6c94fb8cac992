#include "client/artifacts.h"

#include <iostream>
#include <memory>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"

namespace hydroprint::cli {
namespace {

Status artifacts(Program& program, const std::string& job) {
  HP_ASSIGN_OR_RETURN(const auto list, client::list_artifacts(program.daemon(), job));
  if (program.json()) {
    print(list);
    return {};
  }
  for (const v1::Artifact& artifact : list.artifacts())
    std::cout << artifact.sha256() << "  " << format_bytes(artifact.size_bytes()) << "  "
              << printable(client::file_name(artifact)) << "\n";
  return {};
}

}  // namespace

void add_artifacts(CLI::App& app, Program& program) {
  auto job = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("artifacts", "List the files that a job produced");
  add_job_argument(*command, *job);
  program.on(*command, [&program, job] { return artifacts(program, job_name(*job)); });
}

}  // namespace hydroprint::cli
