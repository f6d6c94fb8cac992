#include "daemon/workers/preview_worker.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "daemon/platform/durable_file.h"
#include "daemon/store/artifact_files.h"
#include "daemon/workers/worker_outcome.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kMostBytes = 256 << 20;
constexpr std::size_t kAtOnce = 4 << 20;
constexpr std::size_t kWordsKept = 16 << 10;
constexpr std::chrono::milliseconds kTimeToEnd{500};

Error unusable() {
  return {Code::kInternal,
          "the worker's preview cannot be read; check that workers.program is hydroprint-worker",
          ErrorReason::WORKER_UNUSABLE,
          {}};
}

}  // namespace

PreviewWorker::PreviewWorker(std::string key, std::filesystem::path folder)
    : key_(std::move(key)), folder_(std::move(folder)) {}

PreviewWorker::~PreviewWorker() {
  if (worker_.pid > 0) kill_and_wait(worker_);
  discard(folder_);
}

Result<std::unique_ptr<PreviewWorker>> PreviewWorker::start(
    const PreviewRequest& ask, std::int64_t number, const std::filesystem::path& program,
    const std::filesystem::path& confine_program, const confine::Limits& limits, int threads,
    const Layout& layout) {
  std::unique_ptr<PreviewWorker> preview_worker(new PreviewWorker(ask.key, layout.preview(number)));
  Launch plan;
  plan.program = program;
  plan.arguments = {"preview", "--json", fmt::format("--threads={}", threads)};
  plan.inputs = preview_worker->folder_ / "in";
  plan.work = preview_worker->folder_ / "work";
  plan.limits = limits;
  plan.confine_program = confine_program;
  plan.is_asked = true;
  HP_RETURN_IF_ERROR(lay_out_inputs(layout, ask.inputs, plan.inputs));
  HP_RETURN_IF_ERROR(make_folder(plan.work));
  const auto spec_file = plan.work / "spec.json";
  HP_RETURN_IF_ERROR(write_file(spec_file, ask.spec));
  for (std::string& option : spec_options(spec_file)) plan.arguments.push_back(std::move(option));
  HP_ASSIGN_OR_RETURN(preview_worker->worker_, launch(plan));
  return preview_worker;
}

void PreviewWorker::ask(std::int64_t id, const std::string& dip) {
  const std::string line = fmt::format("{{\"id\":{}{}{}}}\n", id, dip.empty() ? "" : ",", dip);
  // The line has a few hundred bytes, which a pipe accepts completely or not at all.
  ssize_t written = 0;
  do {
    written = ::write(worker_.requests.get(), line.data(), line.size());
  } while (written < 0 && errno == EINTR);
  if (written != static_cast<ssize_t>(line.size())) judge_end();
}

std::vector<PreviewFrame> PreviewWorker::read() {
  std::vector<PreviewFrame> frames;
  if (failure_) return frames;
  const bool is_open = drain(worker_.answer, bytes_, kAtOnce);
  for (;;) {
    auto frame = cut_framed(bytes_, kMostBytes);
    if (!frame) judge_end();  // a failure at the start is not a frame
    if (!frame || !*frame) break;
    frames.push_back(std::move(**frame));
  }
  if (!is_open && !failure_) judge_end();
  return frames;
}

void PreviewWorker::judge_end() {
  // The process closes its pipes slightly before it ends.
  const auto ended = wait_for_end(worker_, kTimeToEnd);
  (void)drain(worker_.errors, words_, kWordsKept);
  if (!ended) kill_and_wait(worker_);
  worker_.pid = -1;
  const auto why = ended ? judge(*ended, StopReason::kNothing, words_, bytes_) : std::nullopt;
  failure_ = why ? why->error : unusable();
  if (!failure_->field.empty()) failure_->field.insert(0, "simulate.");
}

}  // namespace hydroprint::daemon
