#include "daemon/workers/slurm/node_jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <sstream>
#include <thread>

#include "daemon/platform/durable_file.h"
#include "daemon/workers/command_run.h"
#include "daemon/workers/slurm/queue.h"
#include "daemon/workers/slurm/submission.h"

namespace hydroprint::daemon::slurm {
namespace {

using SteadyClock = std::chrono::steady_clock;
using Verdict = CheckLine::Verdict;

constexpr std::chrono::milliseconds kTick{50};
constexpr std::chrono::milliseconds kBetweenQueries{1000};
constexpr std::int64_t kMemory_bytes = 256LL << 20;
constexpr std::int64_t kTimeLimit_s = 60;

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> options_of(Settings settings) {
  settings.time_limit_s = kTimeLimit_s;
  Launch launch;
  launch.limits.memory_bytes = kMemory_bytes;
  return sbatch_options(settings, {}, launch);
}

/// The jobs of one check.
class NodeJobs {
 public:
  NodeJobs(const NodeRequirements& required, std::filesystem::path folder,
           const CheckCaller& caller)
      : required_(required), folder_(std::move(folder)), caller_(caller) {}
  ~NodeJobs() { cancel(); }
  NodeJobs(const NodeJobs&) = delete;
  NodeJobs& operator=(const NodeJobs&) = delete;

  Status submit(const Settings& settings, const std::vector<Node>& nodes);
  void collect(std::chrono::milliseconds patience);

 private:
  struct Job {
    std::string node;
    std::optional<QueueEntry> word = {};  // Slurm's last
  };

  // As the installation of an execution does, this distinguishes the jobs from all others.
  [[nodiscard]] std::string label() const { return folder_.filename().string(); }
  [[nodiscard]] std::string name_of(const std::string& node) const {
    return fmt::format("hydroprint-{}-{}", label(), node);
  }
  void query();
  [[nodiscard]] std::optional<CheckLine> answer_of(const Job& job) const;
  [[nodiscard]] std::optional<CheckLine> early_end_of(const Job& job) const;
  [[nodiscard]] CheckLine silence_of(const Job& job) const;
  void cancel();

  const NodeRequirements& required_;
  std::filesystem::path folder_;
  const CheckCaller& caller_;
  std::int64_t asked_s_ = std::time(nullptr);
  std::vector<Job> open_;
};

Status NodeJobs::submit(const Settings& settings, const std::vector<Node>& nodes) {
  const auto script = folder_ / "script";
  HP_RETURN_IF_ERROR(write_file(token_file(folder_), "shared\n"));
  HP_RETURN_IF_ERROR(
      write_file(script, node_check_script(required_, folder_, options_of(settings))));
  for (const Node& node : nodes) {
    if (caller_.is_cancelled()) break;
    open_.push_back({node.name});  // also if sbatch fails, since it may have submitted
    const auto end = run_command({"sbatch", "--parsable", "--job-name=" + name_of(node.name),
                                  "--nodelist=" + node.name, script.string(), node.name},
                                 folder_, kSlurmPatience);
    if (end && end->status == 0) continue;
    const std::string words = !end ? end.error().message : end->errors;
    caller_.add({Verdict::kFault, "node " + node.name,
                 "Slurm refused a job: " + (words.empty() ? "no answer" : words)});
    (void)run_command({"scancel", "--me", "--name=" + name_of(node.name)}, folder_, kSlurmPatience);
    open_.pop_back();
  }
  return {};
}

void NodeJobs::query() {
  const auto end = run_command(queue_command(), folder_, kSlurmPatience);
  const auto queue = end && end->status == 0 ? parse_queue(end->output) : std::nullopt;
  if (!queue) return;
  for (Job& job : open_) {
    const auto at = queue->find(name_of(job.node));
    if (at != queue->end()) job.word = at->second;
  }
}

std::optional<CheckLine> NodeJobs::answer_of(const Job& job) const {
  const auto findings = parse_findings(content_of(findings_file(folder_, job.node)));
  if (!findings) return std::nullopt;
  return judge_node(job.node, *findings, required_, asked_s_, std::time(nullptr));
}

// Returns the line of a job that failed; nullopt if its findings may still appear.
std::optional<CheckLine> NodeJobs::early_end_of(const Job& job) const {
  if (!job.word || job.word->phase != Phase::kEnded || job.word->state == "COMPLETED") {
    return std::nullopt;
  }
  if (auto answer = answer_of(job)) return answer;
  const std::string what = "node " + job.node;
  if (job.word->reason != "NonZeroExitCode") {
    return CheckLine{Verdict::kFault, what,
                     fmt::format("Slurm ended the job of the check: {} ({}); see slurmd.log there",
                                 job.word->state, job.word->reason)};
  }
  return CheckLine{Verdict::kFault, what,
                   fmt::format("{}: the folder is not shared; mount it at this path, with the same "
                               "user id on all machines",
                               folder_.parent_path().string())};
}

CheckLine NodeJobs::silence_of(const Job& job) const {
  const std::string what = "node " + job.node;
  if (job.word && job.word->state == "COMPLETED") {
    return {Verdict::kFault, what,
            fmt::format("{}: the folder is not shared, because the result of the check does not "
                        "appear; mount it at this path",
                        folder_.parent_path().string())};
  }
  const std::string state =
      job.word ? fmt::format(" ({}, {})", job.word->state, job.word->reason) : "";
  return {Verdict::kNote, what, "is busy and did not answer in time" + state + "; check it again"};
}

void NodeJobs::collect(std::chrono::milliseconds patience) {
  const auto deadline = SteadyClock::now() + patience;
  auto next_query = SteadyClock::now() + kBetweenQueries;
  const auto take = [this](auto line_of) {
    std::erase_if(open_, [&](const Job& job) {
      const std::optional<CheckLine> line = line_of(job);
      if (line) caller_.add(*line);
      return line.has_value();
    });
  };
  while (!open_.empty() && SteadyClock::now() < deadline && !caller_.is_cancelled()) {
    take([this](const Job& job) { return answer_of(job); });
    if (SteadyClock::now() >= next_query) {
      query();
      take([this](const Job& job) { return early_end_of(job); });
      next_query = SteadyClock::now() + kBetweenQueries;
    }
    caller_.wait_for(open_.size());
    std::this_thread::sleep_for(kTick);
  }
  if (caller_.is_cancelled()) return;
  for (const Job& job : open_) caller_.add(silence_of(job));
}

void NodeJobs::cancel() {
  std::vector<CommandRun> runs;  // scancel takes one name at a time
  for (const Job& job : open_) {
    auto run = CommandRun::start({"scancel", "--me", "--name=" + name_of(job.node)}, folder_,
                                 kSlurmPatience);
    if (run) runs.push_back(*std::move(run));
  }
  for (CommandRun& run : runs) (void)run.wait();
}

}  // namespace

Status check_nodes(const Settings& settings, const NodeRequirements& required,
                   const std::vector<Node>& nodes, const std::filesystem::path& folder,
                   std::chrono::milliseconds patience, const CheckCaller& caller) {
  NodeJobs jobs(required, folder, caller);
  HP_RETURN_IF_ERROR(jobs.submit(settings, nodes));
  jobs.collect(patience);
  return {};
}

}  // namespace hydroprint::daemon::slurm
