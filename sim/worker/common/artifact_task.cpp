#include "sim/worker/common/artifact_task.h"

#include <chrono>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include "sim/base/artifact_file.h"
#include "sim/base/process/periodic_thread.h"
#include "sim/base/process/progress_sinks.h"

namespace hydroprint::worker {
namespace {

constexpr std::chrono::milliseconds kAppendPeriod(250);

double seconds_now() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
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

Result<std::string> ArtifactTask::report_text(const Report& report) const {
  return report_json(verb_, findings(report), report);
}

Result<std::string> ArtifactTask::json_summary(const Report& report,
                                               const std::filesystem::path& dir) const {
  return summary_json(dir, figures(), report);
}

Status ArtifactTask::write_all(OutFolder& folder, Report& report, Progress& progress,
                               const Context& context) {
  context.progress("inputs", 0);
  report.threads = context.threads;
  HP_RETURN_IF_ERROR(add_inputs(report, input_files()));
  HP_RETURN_IF_ERROR(compute(folder, report, context));
  report.stage_seconds = progress.stage_seconds();
  report.total_s = progress.total_s();
  HP_ASSIGN_OR_RETURN(const std::string text, report_text(report));
  HP_RETURN_IF_ERROR(image::write_artifact(folder.partial() / "report.json", text));
  context.progress("writing", 1);
  return check_cancelled(context);
}

Result<Finished> ArtifactTask::run(const RunOptions& options, Termination& termination,
                                   int stderr_fd) {
  HP_ASSIGN_OR_RETURN(OutFolder folder, OutFolder::plan(options.out));
  const CleanupAtTermination cleanup(termination, [&folder] { folder.abandon(); });
  Report report;
  {
    ProgressSink sink(options, stderr_fd);
    Progress progress(stages(), seconds_now, std::ref(sink));
    const Context context{
        options.threads,
        [&progress](std::string_view stage, double fraction) { progress.update(stage, fraction); },
        [&termination] { return termination.requested(); }};
    Status status = write_all(folder, report, progress, context);
    if (!status) {
      status.error().message = folder.in_terms_of_dir(std::move(status.error().message));
      return tl::unexpected(std::move(status).error());
    }
  }
  HP_ASSIGN_OR_RETURN(std::string text, options.json
                                            ? json_summary(report, folder.dir())
                                            : Result<std::string>(summary(report, folder.dir())));
  termination.decide();
  HP_RETURN_IF_ERROR(folder.commit());
  return Finished{std::move(text), report.warnings};
}

}  // namespace hydroprint::worker
