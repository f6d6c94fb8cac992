#include "daemon/workers/slurm/cluster_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdlib.h>

#include <algorithm>

#include "daemon/config/executable_path.h"
#include "daemon/platform/durable_file.h"
#include "daemon/workers/command_run.h"
#include "daemon/workers/slurm/submission.h"

namespace hydroprint::daemon::slurm {
namespace {

using Verdict = CheckLine::Verdict;

constexpr std::size_t kMostNodes = 32;
constexpr std::chrono::seconds kNodePatience{60};

/// A new folder in the shared folder, deleted at the end.
class ScratchFolder {
 public:
  static Result<ScratchFolder> make(const std::filesystem::path& parent) {
    // Jobs are named after the folder. With a point, it is not the name of an installation.
    std::string path = parent / "check.XXXXXX";
    if (::mkdtemp(path.data()) == nullptr) {
      return system_failure(parent, "no folder can be created in it");
    }
    return ScratchFolder(path);
  }
  ~ScratchFolder() {
    if (!path_.empty()) discard(path_);
  }
  ScratchFolder(ScratchFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  ScratchFolder& operator=(ScratchFolder&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit ScratchFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;
};

tl::unexpected<Error> fault(const std::string& words) {
  return fail(Code::kFailedPrecondition, words);
}

std::string words_of(const CommandEnd& end) {
  if (!end.errors.empty()) return end.errors;
  return end.status < 0 ? fmt::format("no answer within {} s", kSlurmPatience.count())
                        : fmt::format("exit status {}", end.status);
}

Result<std::string> check_programs() {
  const char* const search_path = std::getenv("PATH");
  std::vector<std::string> missing;
  for (const char* program : {"sbatch", "squeue", "scancel", "sinfo"}) {
    if (find_program(program, search_path == nullptr ? "" : search_path).empty()) {
      missing.emplace_back(program);
    }
  }
  if (missing.empty()) return "sbatch, squeue, scancel and sinfo are installed";
  return fault(fmt::format("{}: not in PATH; install the Debian package slurm-client",
                           fmt::join(missing, ", ")));
}

Result<std::vector<Node>> list_nodes(const Settings& settings) {
  HP_ASSIGN_OR_RETURN(const CommandEnd end,
                      run_command(node_list_command(settings.partition), "/", kSlurmPatience));
  if (end.status != 0) {
    return fault(fmt::format("sinfo: {}; check that slurmctld and munged run, and slurm.conf",
                             words_of(end)));
  }
  auto nodes = parse_node_list(end.output, settings.partition);
  if (!nodes) return fault("sinfo printed something else than a list of nodes; check its version");
  return *std::move(nodes);
}

Result<ScratchFolder> check_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) return ScratchFolder::make(folder);
  return fault(
      fmt::format("{}: not a folder; create it on a file system that all nodes mount at "
                  "this path, and give it to the daemon's user",
                  folder.string()));
}

Result<std::string> check_installation(const Settings& settings) {
  HP_RETURN_IF_ERROR(check_installation_folder(settings));
  const auto folder = installation_folder(settings);
  std::error_code ignored;
  return folder.string() + (std::filesystem::exists(folder, ignored)
                                ? " belongs to this user alone"
                                : " is missing; the daemon will create it");
}

Result<std::string> check_submission(const Config& config, const Settings& settings) {
  Launch launch;
  launch.threads = static_cast<int>(std::max<std::int64_t>(1, config.workers_threads));
  launch.limits.memory_bytes = config.workers_memory_mib << 20;
  std::vector<std::string> command = sbatch_options(settings, {}, launch);
  command.insert(command.begin(), "sbatch");
  command.insert(command.end(), {"--test-only", "--wrap=true"});
  HP_ASSIGN_OR_RETURN(const CommandEnd end, run_command(command, "/", kSlurmPatience));
  if (end.status != 0) {
    return fault(
        fmt::format("sbatch --test-only: {}; check [workers.slurm], workers.threads, "
                    "workers.memory_mib and workers.time_limit_s",
                    words_of(end)));
  }
  return fmt::format(
      "a job with the limits of [workers] is accepted by {}, account {}",
      settings.partition.empty() ? "the default partition" : "partition " + settings.partition,
      settings.account.empty() ? "default" : settings.account);
}

std::vector<Node> available_nodes(std::vector<Node> nodes, const CheckCaller& caller) {
  for (const Node& node : nodes) {
    if (is_available(node)) continue;
    caller.add({Verdict::kNote, "node " + node.name, "is " + node.state + " and was not checked"});
  }
  std::erase_if(nodes, [](const Node& node) { return !is_available(node); });
  if (nodes.empty()) {
    caller.add({Verdict::kFault, "nodes",
                "the partition has no node that can run jobs; see sinfo, and check "
                "workers.slurm.partition"});
  }
  if (nodes.size() > kMostNodes) {
    caller.add(
        {Verdict::kNote, "nodes",
         fmt::format("{} can run jobs; the first {} are checked", nodes.size(), kMostNodes)});
    nodes.resize(kMostNodes);
  }
  return nodes;
}

}  // namespace

void check_cluster(const Config& config, const std::string& build_id, const CheckCaller& caller) {
  const Settings settings = settings_of(config);
  const auto folder = check_folder(settings.folder);
  caller.add(check_line("shared folder", folder.map([&](const auto&) {
    return settings.folder.string() + " can be written";
  })));
  if (folder) caller.add(check_line("installation folder", check_installation(settings)));
  const auto programs = check_programs();
  caller.add(check_line("Slurm programs", programs));
  if (!programs || caller.is_cancelled()) return;
  const auto nodes = list_nodes(settings);
  caller.add(check_line("Slurm controller", nodes.map([](const auto& list) {
    return fmt::format("answers; {} {}", list.size(), list.size() == 1 ? "node" : "nodes");
  })));
  if (!nodes || caller.is_cancelled()) return;
  const auto submission = check_submission(config, settings);
  caller.add(check_line("submission", submission));
  if (!submission || !folder || caller.is_cancelled()) return;
  const NodeRequirements required{config.workers_program, build_id, config.confine_program,
                                  !config.workers_allow_without_landlock};
  const Status checked = check_nodes(settings, required, available_nodes(*nodes, caller),
                                     folder->path(), kNodePatience, caller);
  if (!checked) caller.add({Verdict::kFault, "shared folder", checked.error().message});
}

}  // namespace hydroprint::daemon::slurm
