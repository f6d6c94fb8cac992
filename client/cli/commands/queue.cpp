#include "client/queue.h"

#include <iostream>
#include <memory>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"

namespace hydroprint::cli {
namespace {

void print_names(const char* title, const google::protobuf::RepeatedPtrField<std::string>& names) {
  std::cout << title;
  for (const std::string& name : names) std::cout << " " << name;
  std::cout << "\n";
}

Status show(const Program& program, const Result<v1::Queue>& queue) {
  if (!queue) return tl::unexpected(queue.error());
  if (program.json()) {
    print(*queue);
    return {};
  }
  std::cout << (queue->paused() ? "paused: " + printable(queue->pause_reason()) : "open") << "\n";
  if (!queue->blocked_reason().empty()) {
    std::cout << "no job starts: " << printable(queue->blocked_reason()) << "\n";
  }
  print_names("running:", queue->running_jobs());
  print_names("queued: ", queue->queued_jobs());
  return {};
}

Status move(Program& program, const std::string& name, const std::string& before) {
  HP_ASSIGN_OR_RETURN(const v1::Job job, client::move_job(program.daemon(), name, before));
  if (program.json())
    print(job);
  else
    std::cout << job.name() << " moved" << std::endl;
  return {};
}

void add_pause(CLI::App& parent, Program& program) {
  auto reason = std::make_shared<std::string>();
  CLI::App* command =
      parent.add_subcommand("pause", "Pause the queue: start no further job until resumed");
  command->add_option("--reason", *reason, "Reason, shown to others")->type_name("TEXT");
  program.on(*command, [&program, reason] {
    return show(program, client::pause_queue(program.daemon(), *reason));
  });
}

void add_move(CLI::App& parent, Program& program) {
  auto job = std::make_shared<std::string>();
  auto before = std::make_shared<std::string>();
  CLI::App* command =
      parent.add_subcommand("move", "Move a queued job before another one, or to the end");
  add_job_argument(*command, *job);
  command
      ->add_option("--before", *before,
                   "Insert before this job; default: after all jobs of the same owner")
      ->type_name("JOB");
  program.on(*command, [&program, job, before] {
    return move(program, job_name(*job), before->empty() ? "" : job_name(*before));
  });
}

}  // namespace

void add_queue(CLI::App& app, Program& program) {
  CLI::App* command = app.add_subcommand("queue", "Show, pause, resume or reorder the queue");
  command->require_subcommand(0, 1);
  for (CLI::App* shown : {command, command->add_subcommand("show", "Show the queue (default)")})
    program.on(*shown, [&program] { return show(program, client::get_queue(program.daemon())); });
  add_pause(*command, program);
  program.on(*command->add_subcommand("resume", "Resume the queue"),
             [&program] { return show(program, client::resume_queue(program.daemon())); });
  add_move(*command, program);
}

}  // namespace hydroprint::cli
