#include "daemon/confine/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <sstream>

#include "sim/base/result.h"

namespace hydroprint::confine {
namespace {

constexpr std::int64_t kMiB = 1 << 20;
constexpr std::int64_t kLargest = std::int64_t{1} << 40;

constexpr const char* kFooter =
    R"(hydroprint-confine --inputs DIR --work DIR --memory-mib N [OPTIONS] -- PROGRAM [ARGUMENTS]

Examples:
  hydroprint-confine --inputs in --work work --memory-mib 4096 -- hydroprint-worker simulate --mesh in/spot.obj --out work/out
  hydroprint-confine --check

Arguments after -- are PROGRAM, a path or a name in PATH, and its arguments. PROGRAM inherits the working directory, the
descriptors 0 to 3, and the environment without OMP_PLACES, OMP_PROC_BIND and GOMP_CPU_AFFINITY. It can read system files,
its own folder, --inputs and --work, and write only to --work. It has no network, it cannot start processes, and it can
signal only its own threads. Without Landlock in the kernel, PROGRAM is not started.

Exit status: that of PROGRAM; 2 bad usage; 127 if PROGRAM cannot be started. Of --check: 0 this machine can confine
programs, 4 it cannot.)";

/// Adds an option for a path. CLI11's own conversion would cut paths at spaces.
CLI::Option* add_path(CLI::App& app, const std::string& flag, std::filesystem::path& path,
                      const std::string& description, const std::string& type) {
  const auto set = [flag, &path](const std::string& text) {
    if (text.empty()) throw CLI::ValidationError(flag, "is empty; give a path");
    path = text;
  };
  return app.add_option_function<std::string>(flag, set, description)->type_name(type);
}

/// Adds an option for a limit, which is a count of `unit`.
CLI::Option* add_limit(CLI::App& app, const std::string& flag, std::int64_t& limit,
                       std::int64_t unit, const std::string& description) {
  const auto set = [flag, &limit, unit](const std::string& text) {
    std::int64_t count = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, count);
    const bool is_count = error == std::errc() && rest == end && count >= 1 && count <= kLargest;
    if (!is_count && text != "unlimited") {
      throw CLI::ValidationError(
          flag, "'" + text + "' is not valid; give a whole number from 1, or unlimited");
    }
    limit = is_count ? count * unit : 0;
  };
  return app.add_option_function<std::string>(flag, set, description)->type_name("N|unlimited");
}

void declare(CLI::App& app, Options& o) {
  auto* check = app.add_flag(
      "--check", o.check,
      "Confine this program itself, and print what the kernel granted, as one line of JSON");
  for (CLI::Option* const option :
       {add_path(app, "--inputs", o.inputs, "Folder that PROGRAM can read; required", "DIR"),
        add_path(app, "--work", o.work, "Folder that PROGRAM can read and write; required", "DIR"),
        add_path(app, "--granted", o.granted,
                 "Before PROGRAM starts, write what the kernel granted to this file", "FILE")}) {
    option->excludes(check);
  }
  add_limit(app, "--memory-mib", o.limits.memory_bytes, kMiB,
            "Memory of PROGRAM, in MiB; required. The kernel's limit on its data is a quarter and "
            "512 MiB greater");
  add_limit(app, "--cpu-s", o.limits.cpu_s, 1,
            "Processor time of PROGRAM, in seconds; default: unlimited");
  add_limit(app, "--file-mib", o.limits.file_bytes, kMiB,
            "Size of each file that PROGRAM writes, in MiB; default: unlimited");
  app.add_flag_callback(
      "--allow-without-landlock", [&o] { o.limits.needs_landlock = false; },
      "Also start PROGRAM if the kernel has no Landlock; it can then read, write and delete every "
      "file of its user");
}

void require(bool is_given, const char* name) {
  if (!is_given) throw CLI::RequiredError(name);
}

void check_complete(const CLI::App& app, const Options& o) {
  if (o.check) {
    if (!o.command.empty()) throw CLI::ExcludesError("--check", "-- PROGRAM");
    return;
  }
  require(!o.inputs.empty(), "--inputs");
  require(!o.work.empty(), "--work");
  require(app.count("--memory-mib") > 0, "--memory-mib");
  require(!o.command.empty() && !o.command.front().empty(), "-- PROGRAM");
}

}  // namespace

CommandLine parse_command_line(int argc, char** argv) {
  CommandLine out;
  CLI::App app(
      "Runs a program that reads untrusted files: without network, with access only to its "
      "own folders, and with limits on memory, processor time and file size.");
  app.name("hydroprint-confine");
  app.footer(kFooter);
  app.set_version_flag("--version", "hydroprint-confine " HYDROPRINT_VERSION);
  declare(app, out.options);
  char** const end = argv + argc;
  char** const marker = std::find(argv, end, std::string_view("--"));
  if (marker != end) out.options.command.assign(marker + 1, end);
  try {
    app.parse(static_cast<int>(marker - argv), argv);
    check_complete(app, out.options);
    out.runs = true;
  } catch (const CLI::ParseError& error) {
    std::ostringstream output, errors;
    const bool fine = app.exit(error, output, errors) == 0;
    out.status = fine ? 0 : static_cast<int>(ExitStatus::kUsage);
    out.text = fine ? output.str() : errors.str();
  }
  return out;
}

}  // namespace hydroprint::confine
