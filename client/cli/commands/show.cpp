#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <string>

#include "client/artifacts.h"
#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/format/report_text.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

Status show(Program& program, const std::string& name) {
  HP_ASSIGN_OR_RETURN(const v1::Job job, client::get_job(program.daemon(), name));
  if (program.json()) {
    print(job);
    return {};
  }
  HP_ASSIGN_OR_RETURN(const auto list, client::list_artifacts(program.daemon(), name));
  print_tree(tree_of(job));
  for (const v1::Artifact& artifact : list.artifacts())
    std::cout << fmt::format("{:<20}{}  {}\n", "artifact", client::file_name(artifact),
                             format_bytes(artifact.size_bytes()));
  return {};
}

Status report(Program& program, const std::string& name) {
  HP_ASSIGN_OR_RETURN(const v1::JobReport found, client::job_report(program.daemon(), name));
  if (program.json())
    print(found);
  else
    print_report(found);
  return {};
}

}  // namespace

void add_report(CLI::App& app, Program& program) {
  auto job = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("report", "Show the warnings and the main figures of a job's report");
  add_job_argument(*command, *job);
  command->footer("With --json, prints the whole report.\n\nExample:\n  hydroprint report 7");
  program.on(*command, [&program, job] { return report(program, job_name(*job)); });
}

void add_show(CLI::App& app, Program& program) {
  auto job = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("show", "Show the details of a job");
  add_job_argument(*command, *job);
  command->footer("Example:\n  hydroprint show 7 --json");
  program.on(*command, [&program, job] { return show(program, job_name(*job)); });
}

}  // namespace hydroprint::cli
