#include "daemon/workers/command_run.h"

#include <poll.h>
#include <sys/wait.h>

#include <cstdlib>

#include "daemon/config/executable_path.h"
#include "daemon/workers/worker_outcome.h"

namespace hydroprint::daemon {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kLongestOutput = 16 << 20;
constexpr int kTick_ms = 20;

std::vector<std::string> more_environment() {
  const char* const conf = std::getenv("SLURM_CONF");
  return conf == nullptr ? std::vector<std::string>()
                         : std::vector{std::string("SLURM_CONF=") + conf};
}

}  // namespace

Result<CommandRun> CommandRun::start(const std::vector<std::string>& command,
                                     const std::filesystem::path& folder,
                                     std::chrono::milliseconds patience) {
  const char* const search_path = std::getenv("PATH");
  Launch plan;
  plan.program = find_program(command.front(), search_path == nullptr ? "" : search_path);
  if (plan.program.empty()) {
    return fail(Code::kFailedPrecondition,
                command.front() + ": this program does not exist, or is not in PATH; install it",
                ErrorReason::WORKER_UNUSABLE);
  }
  plan.arguments.assign(command.begin() + 1, command.end());
  plan.inputs = plan.work = folder;
  plan.environment = more_environment();
  plan.confined = false;
  plan.niceness = 0;
  CommandRun out;
  HP_ASSIGN_OR_RETURN(out.process_, launch(plan));
  out.deadline_ = SteadyClock::now() + patience;
  return out;
}

CommandRun::CommandRun(CommandRun&& other) noexcept
    : process_(std::move(other.process_)),
      deadline_(other.deadline_),
      output_(std::move(other.output_)),
      errors_(std::move(other.errors_)) {
  other.process_.pid = -1;
}

CommandRun::~CommandRun() { kill_and_wait(process_); }

void CommandRun::read() {
  for (const auto& [pipe, text] :
       {std::pair(&process_.answer, &output_), std::pair(&process_.errors, &errors_)}) {
    if (!pipe->valid()) continue;
    if (!drain(*pipe, *text, kLongestOutput)) pipe->reset();
    if (text->size() > kLongestOutput) deadline_ = {};  // nothing sensible
  }
}

std::optional<CommandEnd> CommandRun::poll() {
  read();
  std::optional<int> ended = wait_for_end(process_);
  if (!ended && SteadyClock::now() < deadline_) return std::nullopt;
  if (!ended) kill_and_wait(process_);
  read();
  process_.pid = -1;
  const bool has_exited = ended && WIFEXITED(*ended);
  return CommandEnd{has_exited ? WEXITSTATUS(*ended) : -1, !ended.has_value(), std::move(output_),
                    last_line(errors_)};
}

CommandEnd CommandRun::wait() {
  for (;;) {
    if (auto end = poll()) return *std::move(end);
    std::vector<pollfd> fds;
    for (const int fd : descriptors()) fds.push_back({fd, POLLIN, 0});
    ::poll(fds.data(), fds.size(), kTick_ms);
  }
}

std::vector<int> CommandRun::descriptors() const {
  std::vector<int> out;
  for (const UniqueFd* fd : {&process_.handle, &process_.answer, &process_.errors}) {
    if (fd->valid()) out.push_back(fd->get());
  }
  return out;
}

Result<CommandEnd> run_command(const std::vector<std::string>& command,
                               const std::filesystem::path& folder,
                               std::chrono::milliseconds patience) {
  HP_ASSIGN_OR_RETURN(CommandRun running, CommandRun::start(command, folder, patience));
  return running.wait();
}

}  // namespace hydroprint::daemon
