#include "daemon/config/slurm_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kLongestName = 32;

// Options of sbatch on which the daemon relies.
constexpr std::array<std::string_view, 18> kOwnOptions{
    "--job-name", "--requeue", "--no-requeue", "--array",   "--export",   "--propagate",
    "--chdir",    "--input",   "--output",     "--error",   "--nodes",    "--ntasks",
    "--wrap",     "--wait",    "--test-only",  "--cluster", "--clusters", "--parsable"};

bool consists_of(std::string_view text, std::string_view extra) {
  return std::all_of(text.begin(), text.end(), [extra](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           extra.find(c) != std::string_view::npos;
  });
}

bool is_installation(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && consists_of(name, "") &&
         std::none_of(name.begin(), name.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
}

tl::unexpected<Error> refused(const std::string& words) {
  return fail(Code::kInvalidArgument, "workers.slurm." + words, ErrorReason::CONFIG_INVALID);
}

Status check_option(const std::string& option) {
  if (!option.starts_with("--") || !consists_of(option, "-_.,:=@%+/*")) {
    return refused(fmt::format(
        "options: \"{}\" is not an option of sbatch; write options like --qos=low, separated by "
        "spaces",
        option));
  }
  const std::string name = option.substr(0, option.find('='));
  if (std::find(kOwnOptions.begin(), kOwnOptions.end(), name) == kOwnOptions.end()) return {};
  return refused(fmt::format("options: the daemon sets {} itself; remove it", name));
}

}  // namespace

std::vector<std::string> slurm_options(const Config& config) {
  std::vector<std::string> out;
  std::istringstream words(config.slurm_options);
  for (std::string word; words >> word;) out.push_back(word);
  return out;
}

Status check_slurm(const Config& config) {
  if (config.workers_executor != "slurm") return {};
  if (!std::filesystem::path(config.slurm_folder).is_absolute()) {
    return refused(
        "folder is needed for the executor \"slurm\"; give the absolute path of a folder that "
        "this machine and all nodes share");
  }
  if (!is_installation(config.slurm_installation)) {
    return refused(
        fmt::format("installation must be 1 to {} lower-case letters and digits, such as \"lab2\"",
                    kLongestName));
  }
  for (const auto& [key, value] :
       {std::pair("partition", &config.slurm_partition), {"account", &config.slurm_account}}) {
    if (!consists_of(*value, "-_.,")) {
      return refused(fmt::format("{}: \"{}\" is not a name that Slurm can have", key, *value));
    }
  }
  for (const std::string& option : slurm_options(config)) HP_RETURN_IF_ERROR(check_option(option));
  return {};
}

}  // namespace hydroprint::daemon
