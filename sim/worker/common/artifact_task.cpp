#include "sim/worker/common/artifact_task.h"

#include <sys/resource.h>

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "proto/warning_message.h"
#include "proto/write_json.h"
#include "sim/base/process/periodic_thread.h"
#include "sim/base/process/progress_sinks.h"

namespace hydroprint::worker {
namespace {

constexpr std::chrono::milliseconds kAppendPeriod(250);

double seconds_now() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

/// Returns the largest memory of this process so far.
double peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

/// Sends progress to the pipe or file, if there is one, and to stderr, if it is a terminal. A
/// thread of its own appends to the file, so that a slow disk does not slow the computation.
class ProgressSink {
 public:
  ProgressSink(const RunOptions& options, int stderr_fd)
      : pipe_(options.progress_fd), file_(options.progress_file), line_(stderr_fd) {
    if (options.progress_file.empty()) return;
    appending_.emplace(kAppendPeriod, [this] { file_.append(); });
  }
  ~ProgressSink() {
    appending_.reset();
    file_.append();
  }
  ProgressSink(const ProgressSink&) = delete;
  ProgressSink& operator=(const ProgressSink&) = delete;

  void operator()(const ProgressReport& report) {
    pipe_.write(report);
    file_.write(report);
    line_.show(report);
  }

 private:
  ProgressPipe pipe_;
  ProgressFile file_;
  ProgressLine line_;
  std::optional<PeriodicThread> appending_;
};

}  // namespace

Status ArtifactTask::write_all(OutFolder& folder, Progress& progress, const Context& context) {
  context.progress("inputs", 0);
  v1::RunFacts& run = run_facts();
  run.set_program("hydroprint-worker");
  run.set_version(HYDROPRINT_VERSION);
  run.set_verb(verb_);
  run.set_threads(context.threads);
  HP_RETURN_IF_ERROR(add_inputs(run, input_files()));
  HP_RETURN_IF_ERROR(compute(folder, run, context));
  for (const auto& [stage, seconds] : progress.stage_seconds())
    (*run.mutable_stage_seconds())[stage] = seconds;
  run.set_total_seconds(progress.total_s());
  run.set_peak_memory_bytes(peak_memory_bytes());
  HP_RETURN_IF_ERROR(write_message(folder.partial() / "report.json", report()));
  context.progress("writing", 1);
  return check_cancelled(context);
}

Result<std::string> ArtifactTask::json_summary(const std::filesystem::path& dir) {
  using Json = nlohmann::ordered_json;
  HP_ASSIGN_OR_RETURN(const std::string text, json_file_of(report()));
  const Json out = {{"out", dir.string()}, {"report", Json::parse(text)}};
  return out.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<Finished> ArtifactTask::run(const RunOptions& options, Termination& termination,
                                   int stderr_fd) {
  HP_ASSIGN_OR_RETURN(OutFolder folder, OutFolder::plan(options.out));
  const CleanupAtTermination cleanup(termination, [&folder] { folder.abandon(); });
  {
    ProgressSink sink(options, stderr_fd);
    Progress progress(stages(), seconds_now, std::ref(sink));
    const Context context{
        options.threads,
        [&progress](std::string_view stage, double fraction) { progress.update(stage, fraction); },
        [&termination] { return termination.requested(); }};
    Status status = write_all(folder, progress, context);
    if (!status) {
      status.error().message = folder.in_terms_of_dir(std::move(status.error().message));
      return tl::unexpected(std::move(status).error());
    }
  }
  Finished out;
  HP_ASSIGN_OR_RETURN(out.summary, options.json ? json_summary(folder.dir())
                                                : Result<std::string>(summary(folder.dir())));
  for (const v1::Warning& warning : run_facts().warnings())
    out.warnings.push_back(text_of(warning));
  termination.decide();
  HP_RETURN_IF_ERROR(folder.commit());
  return out;
}

}  // namespace hydroprint::worker
