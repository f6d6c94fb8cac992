#include "daemon/workers/slurm/script.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sim/base/error_reason.h"

namespace hydroprint::daemon::slurm {
namespace {

// Comments are for people who look at the folder of a job that runs.
constexpr const char* kScript = R"sh(#!/bin/sh
{options}# Written by hydroprintd for one execution of a job.
trap 'ended=1' TERM INT
ended=
umask 077
cd -- {folder} || exit 1
mkdir begun 2>/dev/null || exit 1  # this execution has begun before
leave() {{ printf '%s\n' "$2" > "$1.new" && mv -f "$1.new" "$1"; }}
finish() {{
  leave exit "$1" && exit 0
  rm -rf work/out exit.new  # the disk is full
  echo '{{"error":{{"reason":"{disk_full}"}}}}' > answer
  leave exit 4
  exit 1
}}

node=$(uname -n)
build_id=$({print_build_id})
leave begin "$node ${{SLURM_JOB_ID:-?}} $build_id"
[ -z "$ended" ] || finish 143
if [ "$build_id" != {build_id} ]; then
  has=$(printf '%s' "$node has build ${{build_id:-unknown}}" | tr -cd '[:alnum:] ._-')
  echo '{{"error":{{"reason":"{worker_differs}","message":"node '"$has"' of the worker, and the machine of' \
    'the daemon has build '{build_id}'; install the same package on both"}}}}' > answer
  finish 4
fi
(cd -- {inputs} && exec {command}) </dev/null >answer 2>errors
finish $?
)sh";

}  // namespace

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string print_build_id(const std::filesystem::path& worker) {
  return quoted(worker) +
         R"sh( --version --json 2>/dev/null | sed -n 's/.*"build_id" *: *"\([0-9a-f]*\)".*/\1/p')sh";
}

std::string option_lines(const std::vector<std::string>& options) {
  std::string out;
  for (const std::string& option : options) out += "#SBATCH " + option + "\n";
  return out;
}

std::string batch_script(const ScriptPlan& plan) {
  std::vector<std::string> words;
  for (const std::string& word : plan.command) words.push_back(quoted(word));
  return fmt::format(kScript, fmt::arg("options", option_lines(plan.options)),
                     fmt::arg("folder", quoted(plan.folder)),
                     fmt::arg("print_build_id", print_build_id(plan.worker)),
                     fmt::arg("build_id", quoted(plan.build_id)),
                     fmt::arg("command", fmt::join(words, " ")),
                     fmt::arg("inputs", quoted(plan.inputs)),
                     fmt::arg("disk_full", name_of(ErrorReason::DISK_FULL)),
                     fmt::arg("worker_differs", name_of(ErrorReason::WORKER_DIFFERS)));
}

}  // namespace hydroprint::daemon::slurm
