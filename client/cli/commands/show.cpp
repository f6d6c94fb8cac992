#include <iomanip>
#include <iostream>
#include <memory>
#include <string>

#include "client/artifacts.h"
#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

Status show(Program& program, const std::string& name) {
  HP_ASSIGN_OR_RETURN(const client::Job job, client::get_job(program.daemon(), name));
  HP_ASSIGN_OR_RETURN(const auto artifacts, client::list_artifacts(program.daemon(), name));
  Json json = to_json(job);
  if (program.json()) {
    json["artifacts"] = to_json(artifacts);
    print(json);
    return {};
  }
  print_tree(json);
  for (const client::Artifact& artifact : artifacts)
    std::cout << std::setw(20) << "artifact" << artifact.file_name() << "  "
              << format_bytes(artifact.size_bytes) << "\n";
  return {};
}

}  // namespace

void add_show(CLI::App& app, Program& program) {
  auto job = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("show", "Show the details of a job");
  add_job_argument(*command, *job);
  command->footer("Example:\n  hydroprint show 7 --json");
  program.on(*command, [&program, job] { return show(program, job_name(*job)); });
}

}  // namespace hydroprint::cli
