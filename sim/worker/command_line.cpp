#include "sim/worker/command_line.h"

#include <fcntl.h>
#include <google/protobuf/message.h>
#include <sched.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/flags/field_flag.h"
#include "sim/base/process/progress_sinks.h"
#include "sim/worker/build_id.h"
#include "sim/worker/common/fields.h"
#include "sim/worker/common/flags.h"
#include "sim/worker/common/input_folder.h"
#include "sim/worker/registry.h"
#include "sim/worker/spec_file.h"

namespace hydroprint::worker {
namespace {

using google::protobuf::Message;

int all_cores() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return std::max(1, CPU_COUNT(&set));
}

/// Flags that do not depend on the verb, as typed.
struct RunFlags {
  RunOptions options;
  std::optional<std::string> spec;    ///< file name, or "-" for stdin
  std::optional<std::string> inputs;  ///< folder
};

void add_path(CLI::App& app, const std::string& flag, std::filesystem::path& path,
              const std::string& description, const std::string& type) {
  // CLI11's own path option splits paths at spaces.
  app.add_option_function<std::string>(
         flag, [&path](const std::string& text) { path = text; }, description)
      ->type_name(type);
}

CommandLine refuse(const RunFlags& run, ExitStatus status, Error error) {
  CommandLine out;
  out.action = CommandLine::Action::kRefuse;
  out.run = run.options;
  out.spec_file = run.spec;
  out.status = status;
  out.error = std::move(error);
  return out;
}

/// Parses the command line of one verb.
class VerbParser {
 public:
  VerbParser(CLI::App& program, const Verb& verb, RunFlags& run);

  [[nodiscard]] bool is_chosen() const { return app_.parsed(); }
  /// Returns the outcome if the verb is chosen. Called after parsing.
  [[nodiscard]] CommandLine settle();

 private:
  void add_run_flags();
  void add_spec_flags();
  [[nodiscard]] std::string usage_problem() const;
  [[nodiscard]] Status read_files();
  [[nodiscard]] Result<std::unique_ptr<Task>> plan() const;
  [[nodiscard]] Status create_progress_file() const;
  [[nodiscard]] std::filesystem::path inputs() const;
  [[nodiscard]] int threads() const;
  [[nodiscard]] CommandLine refuse_options(const Error& error) const;

  Verb verb_;
  RunFlags& run_;
  CLI::App& app_;
  std::unique_ptr<Message> spec_;
  Flags flags_;
  std::vector<CLI::Option*> verb_flags_;  ///< flags that `--spec` replaces
};

VerbParser::VerbParser(CLI::App& program, const Verb& verb, RunFlags& run)
    : verb_(verb),
      run_(run),
      app_(*program.add_subcommand(verb.name, verb.summary)),
      spec_(verb.spec_template->New()),
      flags_(app_, *spec_) {
  app_.footer(verb.examples);
  add_run_flags();
  add_spec_flags();
  const auto count = app_.get_options().size();
  verb_.add_flags(flags_);
  const auto options = app_.get_options();
  verb_flags_.assign(options.begin() + static_cast<std::ptrdiff_t>(count), options.end());
}

void VerbParser::add_run_flags() {
  RunOptions& options = run_.options;
  if (verb_.leaves_folder) {
    add_path(app_, "--out", options.out,
             "Artifact folder to create; replaces the folder of an earlier run", "DIR");
    app_.get_option("--out")->required();
    app_.add_option("--progress-fd", options.progress_fd,
                    "File descriptor for progress, one JSON object per line")
        ->type_name("N");
    add_path(app_, "--progress-file", options.progress_file,
             "File to which the same lines are appended, at most four times a second", "FILE");
    app_.get_option("--progress-file")->excludes("--progress-fd");
  }
  app_.add_flag("--json", options.json, "Print the summary or error as one JSON object");
  flags::add_field(app_, *spec_, *spec_->GetDescriptor()->FindFieldByName("threads"))
      ->description("Number of threads; default: all cores");
}

void VerbParser::add_spec_flags() {
  app_.add_option_function<std::string>(
          "--spec",
          [this](const std::string& file) {
            run_.spec = file;
            for (CLI::Option* flag : verb_flags_) flag->required(false);
          },
          "Options as JSON (" + spec_->GetDescriptor()->name() +
              "), instead of the flags below; - reads stdin")
      ->type_name("FILE.json");
  app_.add_option("--inputs", run_.inputs,
                  "Folder with the files named in --spec; default: the folder of the spec file")
      ->type_name("DIR");
}

/// Describes the first usage error; empty if there is none.
std::string VerbParser::usage_problem() const {
  const RunOptions& o = run_.options;
  if (verb_.leaves_folder && o.out.empty()) return "--out: empty. Name a folder";
  if (verb_.leaves_folder && app_.count("--progress-file") > 0 && o.progress_file.empty()) {
    return "--progress-file: empty. Name a file";
  }
  if (o.progress_fd != -1 && (o.progress_fd < 0 || fcntl(o.progress_fd, F_GETFD) == -1)) {
    return "--progress-fd: not an open file descriptor. Open it first";
  }
  if (!run_.spec && run_.inputs) return "--inputs: needs --spec. Add --spec, or leave --inputs out";
  if (!run_.spec) return {};
  if (*run_.spec == "-" && !verb_.leaves_folder) {
    return "--spec: stdin is reserved for requests. Name a file";
  }
  for (const CLI::Option* flag : verb_flags_) {
    if (flag->count() == 0) continue;
    return flag->get_name() + ": cannot be combined with --spec. Set it in the spec";
  }
  return {};
}

std::filesystem::path VerbParser::inputs() const {
  if (!run_.spec) return {};
  if (run_.inputs) return *run_.inputs;
  return *run_.spec == "-" ? std::filesystem::path()
                           : std::filesystem::path(*run_.spec).parent_path();
}

/// Fills the spec from the files named in the run flags, `--pose`, `--immersions` and `--paint`.
Status VerbParser::read_files() {
  if (!run_.spec) return flags_.read_files();
  const auto from_flags = std::unique_ptr<Message>(spec_->New());
  from_flags->CopyFrom(*spec_);  // --threads
  spec_->Clear();
  HP_RETURN_IF_ERROR(read_spec(*run_.spec, inputs(), *spec_));
  spec_->MergeFrom(*from_flags);
  return {};
}

Result<std::unique_ptr<Task>> VerbParser::plan() const {
  HP_RETURN_IF_ERROR(check_fields(*spec_));
  return verb_.plan(*spec_, InputFolder(inputs(), flags_.pose_file()));
}

Status VerbParser::create_progress_file() const {
  const std::filesystem::path& file = run_.options.progress_file;
  Status made = file.empty() ? Status{} : ProgressFile::create(file);
  if (!made) made.error().message.insert(0, "--progress-file: ");
  return made;
}

int VerbParser::threads() const {
  const auto& field = *spec_->GetDescriptor()->FindFieldByName("threads");
  const auto& reflection = *spec_->GetReflection();
  return reflection.HasField(*spec_, &field) ? reflection.GetInt32(*spec_, &field) : all_cores();
}

/// An invalid flag is bad usage. A number out of range is bad input, and so is any error in a spec
/// or in a file that an option names (metadata "file").
CommandLine VerbParser::refuse_options(const Error& error) const {
  const bool is_usage =
      !run_.spec && error.code != Code::kOutOfRange && !error.metadata.contains("file");
  return refuse(run_, is_usage ? ExitStatus::kUsage : ExitStatus::kBadInput, error);
}

CommandLine VerbParser::settle() {
  if (std::string problem = usage_problem(); !problem.empty()) {
    return refuse(run_, ExitStatus::kUsage, {Code::kInvalidArgument, std::move(problem)});
  }
  if (const Status read = read_files(); !read) {
    return refuse(run_, exit_status(read.error()), read.error());
  }
  auto task = plan();
  if (!task) return refuse_options(task.error());
  if (Status made = create_progress_file(); !made) {
    return refuse(run_, ExitStatus::kUsage, std::move(made).error());
  }
  CommandLine out;
  out.run = run_.options;
  out.run.threads = threads();
  out.spec_file = run_.spec;
  out.task = std::move(*task);
  return out;
}

CommandLine print(std::string text) {
  CommandLine out;
  out.action = CommandLine::Action::kPrint;
  out.text = std::move(text);
  return out;
}

CommandLine print_version(bool json) {
  if (!json) return print("hydroprint-worker " HYDROPRINT_VERSION "\n");
  Result<std::string> id = build_id();
  if (!id) {
    RunFlags run;
    run.options.json = true;
    return refuse(run, exit_status(id.error()), std::move(id).error());
  }
  const nlohmann::ordered_json line = {{"version", HYDROPRINT_VERSION},
                                       {"build_id", std::move(*id)}};
  return print(line.dump() + "\n");
}

}  // namespace

CommandLine parse_command_line(int argc, const char* const* argv) {
  CLI::App app(
      "Runs one computation for hydrographic printing and writes an artifact folder.\n"
      "Needs no daemon and no network.");
  app.name("hydroprint-worker");
  CLI::Option* const version =
      app.set_version_flag("--version", "hydroprint-worker " HYDROPRINT_VERSION);
  CLI::Option* const json =
      app.add_flag("--json")
          ->description("With --version: print the version and build_id as one JSON object")
          ->needs(version);
  app.require_subcommand(1);
  RunFlags run;
  std::vector<std::unique_ptr<VerbParser>> parsers;
  for (const Verb& verb : verbs()) {
    parsers.push_back(std::make_unique<VerbParser>(app, verb, run));
  }

  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForVersion&) {
    return print_version(json->count() > 0);
  } catch (const CLI::CallForHelp&) {
    return print(app.help());
  } catch (const CLI::CallForAllHelp&) {
    return print(app.help());
  } catch (const CLI::ParseError& error) {
    // CLI11 stops at the first error, which may come before --json.
    run.options.json = std::find(argv, argv + argc, std::string_view("--json")) != argv + argc;
    return refuse(run, ExitStatus::kUsage,
                  {Code::kInvalidArgument, std::string(error.what()) + ". See --help"});
  }
  const auto chosen = std::find_if(parsers.begin(), parsers.end(),
                                   [](const auto& parser) { return parser->is_chosen(); });
  return (*chosen)->settle();
}

}  // namespace hydroprint::worker
