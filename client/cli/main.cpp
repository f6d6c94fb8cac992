#include <stdlib.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/cli/program/usage.h"
#include "client/cli/rig_session/held_lease.h"
#include "client/cli/terminal/console.h"
#include "client/connection/connection.h"

namespace hydroprint::cli {
namespace {

constexpr char kFooter[] = R"(Examples:
  hydroprint sample globe --out sample
  hydroprint submit simulate --mesh sample/globe.obj --texture sample/globe.png --out result
  hydroprint list --state RUNNING
  hydroprint show 7 --json
  hydroprint rig status
  hydroprint dip --simulate-job 7 --out result

Exit status: 0 success; 2 wrong usage; 3 bad input, or refused by the daemon;
4 failed, or data was damaged in transit; 5 no daemon responds; 130 cancelled.)";

// Adds the parent commands to the usage line, which CLI11 omits.
class Help : public CLI::Formatter {
 public:
  std::string make_usage(const CLI::App* app, std::string) const override {
    return CLI::Formatter::make_usage(app, full_name(*app));
  }
};

void add_commands(CLI::App& app, Program& program) {
  add_sample(app, program);
  add_upload(app, program);
  add_submit(app, program);
  add_inspect(app, program);
  add_preview(app, program);
  add_watch(app, program);
  add_list(app, program);
  add_show(app, program);
  add_report(app, program);
  add_events(app, program);
  add_cancel(app, program);
  add_retry(app, program);
  add_delete(app, program);
  add_artifacts(app, program);
  add_download(app, program);
  add_assets(app, program);
  add_queue(app, program);
  add_rig(app, program);
  add_camera(app, program);
  add_capture(app, program);
  add_calibrate(app, program);
  add_calibrate_camera(app, program);
  add_calibrations(app, program);
  add_loop(app, program);
  add_plan(app, program);
  add_print(app, program);
  add_dip(app, program);
  add_confirm(app, program);
  add_share(app, program);
  add_pin(app, program);
  add_login(app, program);
  add_users(app, program);
  add_keys(app, program);
  add_sessions(app, program);
  add_audit(app, program);
  add_status(app, program);
  add_admin(app, program);
  add_completion(app, program);
  add_help(app, program);
}

void report(const CLI::App& app, const Program& program, const Error& error) {
  if (program.json()) print({{"error", to_json(error)}});
  const auto wrong_fields = error.metadata.find(client::kWrongFields);
  if (wrong_fields == error.metadata.end()) {
    const std::string word = error.field.empty() ? "" : word_of_field(app, error.field) + ": ";
    std::cerr << "hydroprint: " << printable(word + error.message) << std::endl;
    return;
  }
  std::cerr << "hydroprint: the request has several wrong fields:" << std::endl;
  std::istringstream lines(wrong_fields->second);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t tab = line.find('\t');
    std::cerr << "  " << printable(word_of_field(app, line.substr(0, tab))) << ": "
              << printable(line.substr(tab + 1)) << std::endl;
  }
}

int run(int argc, char** argv) {
  CLI::App app("Computational hydrographic printing: the client of hydroprintd", "hydroprint");
  app.formatter(std::make_shared<Help>());
  app.fallthrough();
  app.require_subcommand(1);
  app.failure_message(usage_error);
  Program program(app);
  add_commands(app, program);
  app.footer(kFooter);  // after the commands, which would inherit it
  if (argc == 1) {
    std::cerr << app.help();
    return static_cast<int>(ExitStatus::kUsage);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitStatus::kUsage);
  }
  const Status status = program.run();
  if (!status) {
    report(app, program, in_our_words(status.error()));
    return exit_code(status.error());
  }
  if (std::cout.flush()) return 0;
  std::cerr << "hydroprint: standard output cannot be written; check the free disk space"
            << std::endl;
  return static_cast<int>(ExitStatus::kFailed);
}

}  // namespace
}  // namespace hydroprint::cli

int main(int argc, char** argv) {
  ::setenv("GRPC_VERBOSITY", "NONE", 0);  // errors are reported once, in our own words
  try {
    return hydroprint::cli::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "hydroprint: " << error.what() << std::endl;
    return static_cast<int>(hydroprint::ExitStatus::kFailed);
  }
}
