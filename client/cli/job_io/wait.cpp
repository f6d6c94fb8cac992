#include "client/cli/job_io/wait.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "client/cli/format/job_display.h"
#include "client/cli/format/json.h"
#include "client/cli/terminal/console.h"

namespace hydroprint::cli {
namespace {

// Cancels the job if requested, and explains how to continue.
Error interrupted(Program& program, const std::string& job, const WaitOptions& options) {
  if (!options.cancel_on_interrupt)
    return {Code::kCancelled,
            "interrupted; " + job + " continues. 'hydroprint watch " + job +
                "' follows it, 'hydroprint cancel " + job + "' cancels it",
            {}};
  client::Connection connection = program.uninterrupted();
  const auto cancelled = client::cancel_job(connection, job);
  if (!cancelled) return cancelled.error();
  return {Code::kCancelled, job + " is being cancelled", {}};
}

std::string summary(const client::Job& job) {
  if (job.cache_hit) return job.name + ": done, cached result of an earlier job";
  if (!job.start_time || !job.end_time) return job.name + ": done";
  using namespace std::chrono;
  return job.name + ": done in " + format_duration(round<seconds>(*job.end_time - *job.start_time));
}

void print_update(const client::JobUpdate& update) {
  Json json = Json::object();
  if (update.job) json["job"] = to_json(*update.job);
  if (update.event) json["event"] = to_json(*update.event);
  print(json);
}

Result<client::Artifact> find(const std::vector<client::Artifact>& artifacts,
                              const std::string& job, const std::string& name) {
  std::string known;
  for (const client::Artifact& artifact : artifacts) {
    if (artifact.file_name() == name) return artifact;
    known += " " + artifact.file_name();
  }
  return fail(Code::kNotFound, job + " has no artifact '" + name + "'; available:" + known);
}

Result<std::vector<client::Artifact>> choose(client::Connection& daemon, const std::string& job,
                                             const std::vector<std::string>& names) {
  HP_ASSIGN_OR_RETURN(auto artifacts, client::list_artifacts(daemon, job));
  if (artifacts.empty()) {
    HP_ASSIGN_OR_RETURN(const client::Job found, client::get_job(daemon, job));
    return fail(Code::kFailedPrecondition,
                job + " is " + std::string(client::name_of(found.state)) +
                    " and has no artifacts; only SUCCEEDED jobs have them");
  }
  if (names.empty()) return artifacts;
  std::vector<client::Artifact> chosen;
  for (const std::string& name : names) {
    HP_ASSIGN_OR_RETURN(auto artifact, find(artifacts, job, name));
    chosen.push_back(std::move(artifact));
  }
  return chosen;
}

}  // namespace

void add_wait_flags(CLI::App& command, WaitOptions& options) {
  command.add_flag("--cancel-on-interrupt", options.cancel_on_interrupt,
                   "Let Ctrl-C cancel the job; by default it continues");
}

Error why(const client::Job& job) {
  const client::JobError error = job.error.value_or(client::JobError{});
  Error why{error.code == "INVALID_ARGUMENT" ? Code::kInvalidArgument : Code::kInternal,
            job.name + " failed: " + error.message,
            error.reason,
            {{"job", job.name}}};
  if (job.state == client::JobState::kCancelled)
    why = {Code::kCancelled, job.name + " was cancelled", {}};
  if (job.state == client::JobState::kInterrupted)
    why = {Code::kInternal,
           job.name + " was interrupted: " +
               (job.dip         ? "the daemon was lost during the dip"
                : job.capture_s ? "the daemon stopped during the capture; start a new capture"
                                : "the daemon stopped during the print; check the printer"),
           {}};
  // A dip that ended early explains what to do with film and object.
  const std::string advice = job.dip_status ? job.dip_status->instruction : "";
  if (why.message.find(advice) == std::string::npos) why.message += "; " + advice;
  return why;
}

Result<client::Job> follow_job(Program& program, const std::string& job,
                               const WaitOptions& options) {
  JobDisplay display(job, options.descriptor);
  auto finished = client::watch_job(
      program.daemon(), job,
      [&](const client::JobUpdate& update) {
        options.json_lines ? print_update(update) : display.update(update);
      },
      [&](const Error& error) {
        if (!options.json_lines) display.say("hydroprint: " + error.message + "; retrying");
      });
  if (finished && finished->state == client::JobState::kSucceeded && !options.json_lines)
    display.say(summary(*finished));
  return finished;
}

Result<client::Job> wait_for(Program& program, const std::string& job, const WaitOptions& options) {
  auto finished = follow_job(program, job, options);
  if (!finished && finished.error().code == Code::kCancelled)
    return tl::unexpected(interrupted(program, job, options));
  if (finished && finished->state != client::JobState::kSucceeded)
    return tl::unexpected(why(*finished));
  return finished;
}

Result<std::vector<Downloaded>> download_all(client::Connection& daemon, const std::string& job,
                                             const std::vector<std::string>& names,
                                             const std::filesystem::path& folder) {
  HP_ASSIGN_OR_RETURN(const auto artifacts, choose(daemon, job, names));
  ProgressLine line(STDERR_FILENO);
  std::vector<Downloaded> files;
  for (const client::Artifact& artifact : artifacts) {
    auto path =
        client::download(daemon, artifact, folder, [&](std::int64_t done, std::int64_t total) {
          line.show(
              "downloading " + artifact.file_name(),
              static_cast<double>(done) / static_cast<double>(std::max<std::int64_t>(total, 1)),
              format_bytes(total));
        });
    if (!path) return tl::unexpected(std::move(path).error());
    files.push_back({std::move(*path), artifact});
  }
  return files;
}

nlohmann::ordered_json to_json(const std::vector<Downloaded>& files) {
  Json json = Json::array();
  for (const Downloaded& file : files)
    json.push_back({{"path", file.path.string()},
                    {"sha256", file.artifact.sha256},
                    {"size_bytes", file.artifact.size_bytes}});
  return json;
}

}  // namespace hydroprint::cli
