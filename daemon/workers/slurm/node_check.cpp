#include "daemon/workers/slurm/node_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

#include "daemon/workers/child_process.h"
#include "daemon/workers/slurm/script.h"

namespace hydroprint::daemon::slurm {
namespace {

using Verdict = CheckLine::Verdict;

constexpr std::int64_t kMostClockDifference_s = 60;

constexpr const char* kCheckScript = R"sh(#!/bin/sh
{options}# Written by hydroprint admin check.
umask 077
cd -- {folder} && [ -f token ] || exit 1
{{
  date '+clock_s %s'
  [ -x {worker} ] && echo has_worker
  echo "build_id $({print_build_id})"
  words=$({confine} --check{flags} 2>&1 >/dev/null) && key=confine_warning || key=confine_error
  [ "$key$words" = confine_warning ] ||
    printf '%s %s\n' "$key" "$(printf '%s\n' "${{words:-failed}}" | tail -n 1)"
  echo end
}} > "$1.new" && mv "$1.new" "$1.findings"
)sh";

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream fields(line);
  for (std::string field; std::getline(fields, field, '|');) out.push_back(field);
  return out;
}

bool is_node_name(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  });
}

// Returns how far the clock is from the time between `asked_s` and `read_s`.
std::int64_t clock_difference_s(std::int64_t clock_s, std::int64_t asked_s, std::int64_t read_s) {
  return clock_s - std::clamp(clock_s, std::min(asked_s, read_s), read_s);
}

std::vector<std::string> faults_of(const NodeFindings& findings, const NodeRequirements& required) {
  std::vector<std::string> out;
  if (!findings.has_worker) {
    out.push_back(fmt::format("{}: the worker is missing; install hydroprint at the same path",
                              required.worker.string()));
  } else if (!required.build_id.empty() && findings.build_id != required.build_id) {
    out.push_back(fmt::format(
        "has build {} of the worker, and this machine has build {}; install the same package on "
        "both",
        findings.build_id.empty() ? "unknown" : findings.build_id, required.build_id));
  }
  if (!findings.confine_error.empty()) {
    out.push_back("cannot confine workers: " + findings.confine_error);
  }
  return out;
}

}  // namespace

bool is_available(const Node& node) {
  constexpr std::array<std::string_view, 6> kUnavailable{"down",  "drain",   "fail",
                                                         "error", "unknown", "future"};
  return node.state.find('*') == std::string::npos &&  // '*': does not respond
         std::none_of(kUnavailable.begin(), kUnavailable.end(),
                      [&](std::string_view state) { return node.state.starts_with(state); });
}

std::vector<std::string> node_list_command(const std::string& partition) {
  std::vector<std::string> out{"sinfo", "--noheader", "--Node", "--format=%N|%P|%T"};
  if (!partition.empty()) out.push_back("--partition=" + partition);
  return out;
}

std::optional<std::vector<Node>> parse_node_list(std::string_view output,
                                                 const std::string& partition) {
  std::vector<Node> nodes;
  std::istringstream lines{std::string(output)};
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> fields = fields_of(line);
    if (fields.size() != 3 || !is_node_name(fields[0])) return std::nullopt;
    const bool is_default = fields[1].ends_with('*');
    if (partition.empty() && !is_default) continue;
    const Node node{fields[0], fields[2]};
    if (std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
  }
  return nodes;
}

std::string node_check_script(const NodeRequirements& required, const std::filesystem::path& folder,
                              const std::vector<std::string>& options) {
  return fmt::format(
      kCheckScript, fmt::arg("options", option_lines(options)), fmt::arg("folder", quoted(folder)),
      fmt::arg("worker", quoted(required.worker)),
      fmt::arg("print_build_id", print_build_id(required.worker)),
      fmt::arg("confine", quoted(required.confine_program)),
      fmt::arg("flags", required.needs_landlock ? "" : std::string(" ") + kAllowWithoutLandlock));
}

std::filesystem::path token_file(const std::filesystem::path& folder) { return folder / "token"; }

std::filesystem::path findings_file(const std::filesystem::path& folder, const std::string& node) {
  return folder / (node + ".findings");
}

std::optional<NodeFindings> parse_findings(std::string_view text) {
  NodeFindings out;
  bool is_complete = false;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    const std::string key = line.substr(0, line.find(' '));
    const std::string value = key.size() < line.size() ? line.substr(key.size() + 1) : "";
    if (key == "clock_s") {
      (void)std::from_chars(value.data(), value.data() + value.size(), out.clock_s);
    } else if (key == "has_worker") {
      out.has_worker = true;
    } else if (key == "build_id") {
      out.build_id = value;
    } else if (key == "confine_error") {
      out.confine_error = value;
    } else if (key == "confine_warning") {
      out.confine_warning = value;
    } else if (key == "end") {
      is_complete = true;
    }
  }
  return is_complete && out.clock_s > 0 ? std::optional(out) : std::nullopt;
}

CheckLine judge_node(const std::string& node, const NodeFindings& findings,
                     const NodeRequirements& required, std::int64_t asked_s, std::int64_t read_s) {
  const std::string what = "node " + node;
  if (const auto faults = faults_of(findings, required); !faults.empty()) {
    return {Verdict::kFault, what, fmt::format("{}", fmt::join(faults, "; "))};
  }
  if (!findings.confine_warning.empty()) return {Verdict::kNote, what, findings.confine_warning};
  const std::int64_t difference_s = clock_difference_s(findings.clock_s, asked_s, read_s);
  if (std::abs(difference_s) > kMostClockDifference_s) {
    return {Verdict::kNote, what,
            fmt::format("can run workers; its clock is {} s {}, which does no harm to jobs",
                        std::abs(difference_s), difference_s > 0 ? "fast" : "slow")};
  }
  return {Verdict::kOk, what, "shares the folder, has the same build, can confine workers"};
}

}  // namespace hydroprint::daemon::slurm
