#include "daemon/admin/check.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <iostream>

#include "daemon/admin/offline_state.h"
#include "daemon/admin/store_check.h"
#include "daemon/platform/check_line.h"
#include "daemon/platform/private_files.h"
#include "daemon/store/database/schema.h"
#include "daemon/store/state_lock.h"
#include "daemon/workers/child_process.h"
#include "daemon/workers/program_digest.h"
#include "daemon/workers/slurm/cluster_check.h"
#include "sim/base/utf8.h"

namespace hydroprint::admin {
namespace {

using daemon::check_line;
using daemon::CheckLine;
using Clock = std::chrono::steady_clock;

constexpr const char* kInstalledFile = "/etc/hydroprint/hydroprintd.toml";
constexpr std::chrono::seconds kQuiet{2};

volatile std::sig_atomic_t is_interrupted = 0;

/// Prints lines, and remembers whether one is a fault.
class Printer {
 public:
  void add(const CheckLine& line) {
    const bool is_fault = line.verdict == CheckLine::Verdict::kFault;
    has_fault_ = has_fault_ || is_fault;
    const char* const verdict = is_fault                                    ? "FAULT"
                                : line.verdict == CheckLine::Verdict::kNote ? "note "
                                                                            : "ok   ";
    std::cout << fmt::format("{} {}: {}", verdict, one_line(line.what), one_line(line.detail))
              << std::endl;
    shown_ = Clock::now();
  }
  /// Says on stderr what takes long, every two seconds.
  void wait_for(std::size_t nodes) {
    if (Clock::now() < shown_ + kQuiet) return;
    std::cerr << fmt::format("waiting for {} {} ...", nodes, nodes == 1 ? "node" : "nodes")
              << std::endl;
    shown_ = Clock::now();
  }
  [[nodiscard]] bool has_fault() const { return has_fault_; }

 private:
  bool has_fault_ = false;
  Clock::time_point shown_ = Clock::now();
};

CheckLine check_confine(const daemon::Config& config) {
  constexpr const char* kWhat = "confinement";
  const auto warning =
      daemon::check_confinement(config.confine_program, !config.workers_allow_without_landlock);
  if (warning && !warning->empty()) return {CheckLine::Verdict::kNote, kWhat, *warning};
  return check_line(kWhat, warning.map([](const std::string&) -> std::string {
    return "this machine can confine workers";
  }));
}

Result<daemon::Layout> check_state(const std::string& named) {
  HP_ASSIGN_OR_RETURN(const std::filesystem::path root, state_root(named));
  const daemon::Layout layout{root};
  std::error_code ignored;
  if (!std::filesystem::is_directory(root, ignored)) {
    return fail(Code::kNotFound,
                root.string() +
                    ": does not exist; name the right folder with --state-dir, or start the "
                    "daemon once, which creates it");
  }
  HP_RETURN_IF_ERROR(daemon::check_is_mine(root));
  if (::access(root.c_str(), R_OK | W_OK | X_OK) != 0) {
    return daemon::system_failure(root, "cannot be written");
  }
  HP_RETURN_IF_ERROR(daemon::check_build(layout.database()));
  return layout;
}

Result<std::string> check_private(const daemon::Layout& layout) {
  std::error_code ignored;
  if (!std::filesystem::exists(layout.database(), ignored)) {
    return layout.root.string() + " can be written";  // the first start makes it private
  }
  for (const daemon::PrivatePath& each : daemon::private_paths(layout)) {
    HP_RETURN_IF_ERROR(daemon::check_is_mine(each.path));
    HP_RETURN_IF_ERROR(daemon::check_mode(each.path, each.mode));
  }
  return layout.root.string() + " can be written, and only by this user";
}

void check_state_and_store(const std::string& named, Printer& printer) {
  const auto layout = check_state(named);
  printer.add(check_line("state folder", layout.and_then(check_private)));
  if (!layout) return;
  check_store(
      *layout, [&](const CheckLine& line) { printer.add(line); },
      [] { return is_interrupted != 0; });
}

void check_all(const daemon::Config& config, Printer& printer) {
  const auto build_id = daemon::ProgramDigest(config.workers_program).get();
  printer.add(check_line("worker", build_id.map([&](const std::string& id) {
    return fmt::format("{}, build {}", config.workers_program, id);
  })));
  printer.add(check_confine(config));
  check_state_and_store(config.store_state_dir, printer);
  if (config.workers_executor != "slurm" || is_interrupted != 0) return;
  daemon::slurm::check_cluster(
      config, build_id.value_or(""),
      {[&](const CheckLine& line) { printer.add(line); },
       [&](std::size_t nodes) { printer.wait_for(nodes); }, [] { return is_interrupted != 0; }});
}

}  // namespace

std::string configuration_file(const std::string& named) {
  std::error_code ignored;
  return named.empty() && std::filesystem::exists(kInstalledFile, ignored) ? kInstalledFile : named;
}

ExitStatus check(const std::string& file, const Result<daemon::Config>& config) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) { is_interrupted = 1; });
  }
  Printer printer;
  printer.add(check_line("configuration", config.map([&](const daemon::Config& valid) {
    return fmt::format("{}; executor {}", file.empty() ? "built-in settings" : file + " is valid",
                       valid.workers_executor);
  })));
  if (config) check_all(*config, printer);
  if (is_interrupted != 0) return ExitStatus::kCancelled;
  return printer.has_fault() ? ExitStatus::kFailed : ExitStatus::kDone;
}

}  // namespace hydroprint::admin
