#include "client/cli/job_io/wait.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "client/cli/format/job_display.h"
#include "client/cli/format/json.h"
#include "client/cli/terminal/console.h"
#include "client/name_of.h"
#include "client/time.h"
#include "google/rpc/code.pb.h"

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

std::string summary(const v1::Job& job) {
  if (job.cache_hit()) return job.name() + ": done, cached result of an earlier job";
  const auto start = client::time_of(job.start_time()), end = client::time_of(job.end_time());
  if (!start || !end) return job.name() + ": done";
  using namespace std::chrono;
  return job.name() + ": done in " + format_duration(round<seconds>(*end - *start));
}

Result<v1::Artifact> find(const v1::ListArtifactsResponse& list, const std::string& job,
                          const std::string& name) {
  std::string known;
  for (const v1::Artifact& artifact : list.artifacts()) {
    if (client::file_name(artifact) == name) return artifact;
    known += " " + client::file_name(artifact);
  }
  return fail(Code::kNotFound, job + " has no artifact '" + name + "'; available:" + known);
}

Result<std::vector<v1::Artifact>> choose(client::Connection& daemon, const std::string& job,
                                         const std::vector<std::string>& names) {
  HP_ASSIGN_OR_RETURN(const auto list, client::list_artifacts(daemon, job));
  if (list.artifacts().empty()) {
    HP_ASSIGN_OR_RETURN(const v1::Job found, client::get_job(daemon, job));
    return fail(Code::kFailedPrecondition,
                job + " is " + client::name_of(found.state()) +
                    " and has no artifacts; only SUCCEEDED jobs have them");
  }
  if (names.empty()) return std::vector(list.artifacts().begin(), list.artifacts().end());
  std::vector<v1::Artifact> chosen;
  for (const std::string& name : names) {
    HP_ASSIGN_OR_RETURN(chosen.emplace_back(), find(list, job, name));
  }
  return chosen;
}

// Explains why a dip, print or capture ended when the daemon stopped.
std::string interruption(const v1::Job& job) {
  if (job.has_dip()) return "the daemon stopped during the dip; check the rig and the object";
  if (job.has_capture()) return "the daemon stopped during the capture; start a new capture";
  return "the daemon stopped during the print; check the printer";
}

}  // namespace

void add_wait_flags(CLI::App& command, WaitOptions& options) {
  command.add_flag("--cancel-on-interrupt", options.cancel_on_interrupt,
                   "Let Ctrl-C cancel the job; by default it continues");
}

Error why(const v1::Job& job) {
  const bool is_bad_input = job.error().code() == google::rpc::INVALID_ARGUMENT;
  Error why{is_bad_input ? Code::kInvalidArgument : Code::kInternal,
            job.name() + " failed: " + job.error().message(),
            static_cast<ErrorReason>(job.error().reason()),
            {{"job", job.name()}},
            job.error().field()};
  if (job.state() == v1::Job::CANCELLED)
    why = {Code::kCancelled, job.name() + " was cancelled", {}};
  if (job.state() == v1::Job::INTERRUPTED)
    why = {Code::kInternal, job.name() + " was interrupted: " + interruption(job), {}};
  // For a dip that ended early, the instruction explains what to do with film and object.
  const std::string& advice = job.dip_status().instruction();
  if (why.message.find(advice) == std::string::npos) why.message += "; " + advice;
  return why;
}

Result<v1::Job> follow_job(Program& program, const std::string& job, const WaitOptions& options) {
  JobDisplay display(job, options.descriptor);
  auto finished = client::watch_job(
      program.daemon(), job,
      [&](const v1::WatchJobResponse& update) {
        options.json_lines ? print(update) : display.update(update);
      },
      [&](const Error& error) {
        if (!options.json_lines) display.say("hydroprint: " + error.message + "; retrying");
      });
  if (finished && finished->state() == v1::Job::SUCCEEDED && !options.json_lines)
    display.say(summary(*finished));
  return finished;
}

Result<v1::Job> wait_for(Program& program, const std::string& job, const WaitOptions& options) {
  auto finished = follow_job(program, job, options);
  if (!finished && finished.error().code == Code::kCancelled)
    return tl::unexpected(interrupted(program, job, options));
  if (finished && finished->state() != v1::Job::SUCCEEDED) return tl::unexpected(why(*finished));
  return finished;
}

Result<std::vector<Downloaded>> download_all(client::Connection& daemon, const std::string& job,
                                             const std::vector<std::string>& names,
                                             const std::filesystem::path& folder) {
  HP_ASSIGN_OR_RETURN(const auto artifacts, choose(daemon, job, names));
  ProgressLine line(STDERR_FILENO);
  std::vector<Downloaded> files;
  for (const v1::Artifact& artifact : artifacts) {
    auto path =
        client::download(daemon, artifact, folder, [&](std::int64_t done, std::int64_t total) {
          line.show(
              "downloading " + client::file_name(artifact),
              static_cast<double>(done) / static_cast<double>(std::max<std::int64_t>(total, 1)),
              format_bytes(total));
        });
    if (!path) return tl::unexpected(std::move(path).error());
    files.push_back({std::move(*path), artifact});
  }
  return files;
}

nlohmann::ordered_json files_json(const std::vector<Downloaded>& files) {
  Json json = Json::array();
  for (const Downloaded& file : files) {
    json.push_back(to_json(file.artifact));
    json.back()["path"] = file.path.string();
  }
  return json;
}

}  // namespace hydroprint::cli
