// hydroprint-virtual-rig simulates the drive of a rig and can fail on request.

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "hardware/simulator/drive/virtual_rig.h"
#include "sim/base/utf8.h"

namespace hydroprint::simulated_drive {
namespace {

constexpr int kDefaultPort = 1502;
constexpr const char* kFooter = R"(Examples:
  hydroprint-virtual-rig --profile hardware/profiles/virtual.toml --tcp 1502
  hydroprint-virtual-rig --profile virtual.toml --rtu /tmp/drive --baud 115200 --control /tmp/rig
  hydroprint-virtual-rig --profile virtual.toml --fault late=700ms@5s,press=stop@8s
  printf 'fault drop 3\nstate\n' | socat - UNIX-CONNECT:/tmp/rig
Actions for --fault and the control socket:
  )";

struct Arguments {
  std::string profile, scene, rtu, control, faults;
  int tcp = kDefaultPort;
  int baud = 115200;
  std::string parity = "E";
  int stop_bits = 1;
  double watchdog_s = 0;
  int watchdog_action = 0;
  bool json = false;
};

int refuse(const std::string& message, ExitStatus status) {
  std::cerr << "hydroprint-virtual-rig: " << one_line(message) << std::endl;
  return static_cast<int>(status);
}

int refuse(const Error& error) { return refuse(error.message, exit_status(error)); }

sigset_t block_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signal(SIGPIPE, SIG_IGN);
  return set;
}

Result<Options> options_of(const Arguments& arguments, const CLI::App& app) {
  Options out;
  HP_ASSIGN_OR_RETURN(out.profile, drive::read_drive_profile(arguments.profile));
  if (!arguments.scene.empty()) {
    HP_ASSIGN_OR_RETURN(out.scene, read_scene(arguments.scene));
  }
  HP_ASSIGN_OR_RETURN(out.actions, parse_timed_actions(arguments.faults));
  if (arguments.rtu.empty() || app.count("--tcp") > 0) out.tcp_port = arguments.tcp;
  if (!arguments.rtu.empty()) {
    const auto path = std::filesystem::absolute(arguments.rtu).string();
    HP_ASSIGN_OR_RETURN(out.line, drive::parse_endpoint(fmt::format(
                                      "rtu:{}?baud={}&parity={}&stop={}", path, arguments.baud,
                                      arguments.parity, arguments.stop_bits)));
  }
  out.control = arguments.control;
  if (app.count("--watchdog-s") > 0) out.watchdog_s = arguments.watchdog_s;
  if (app.count("--watchdog-action") > 0) {
    out.watchdog_action = static_cast<std::uint16_t>(arguments.watchdog_action);
  }
  return out;
}

void tell_where(const Options& options, int port, bool as_json) {
  nlohmann::ordered_json where;
  if (options.tcp_port) where["tcp"] = fmt::format("tcp:127.0.0.1:{}", port);
  if (options.line) where["rtu"] = options.line->text();
  if (!options.control.empty()) where["control"] = options.control.string();
  if (as_json) {
    std::cout << where.dump() << std::endl;
    return;
  }
  std::cout << "hydroprint-virtual-rig ready";
  for (const auto& [name, value] : where.items()) {
    std::cout << ' ' << name << '=' << value.get<std::string>();
  }
  std::cout << std::endl;
}

int run(const Options& options, bool as_json) {
  const sigset_t signals = block_signals();
  const auto rig = VirtualRig::start(options);
  if (!rig) return refuse(rig.error());
  tell_where(options, (*rig)->tcp_port(), as_json);
  int signal = 0;
  sigwait(&signals, &signal);
  return 0;
}

void declare(CLI::App& app, Arguments& arguments) {
  app.add_option("--profile", arguments.profile, "Profile of the simulated drive")
      ->required()
      ->type_name("FILE");
  app.add_option("--scene", arguments.scene, "Scene file: object in the gripper, travel, water")
      ->type_name("FILE");
  app.add_option(
         "--tcp", arguments.tcp,
         "Port of 127.0.0.1 to listen on, 0: any free port; default 1502, none with --rtu alone")
      ->check(CLI::Range(0, 65535))
      ->type_name("PORT");
  app.add_option(
         "--rtu", arguments.rtu,
         "Path of a symbolic link to create; it leads to the pseudo-terminal of the serial line")
      ->type_name("PATH");
  app.add_option("--baud", arguments.baud, "Baud rate of the serial line; default 115200");
  app.add_option("--parity", arguments.parity, "Parity of the serial line: N, E or O; default E");
  app.add_option("--stop-bits", arguments.stop_bits,
                 "Stop bits of the serial line: 1 or 2; default 1");
  app.add_option("--control", arguments.control,
                 "Control socket to create; it accepts actions, one per line")
      ->type_name("PATH");
  app.add_option("--fault", arguments.faults, "Actions with optional times, separated by commas")
      ->type_name("LIST");
  app.add_option("--watchdog-s", arguments.watchdog_s,
                 "Seconds until the drive's communication watchdog acts; 0: off; default: the "
                 "longest that the profile permits")
      ->check(CLI::Range(0.0, 60.0));
  app.add_option("--watchdog-action", arguments.watchdog_action,
                 "Register value of the watchdog's action; default: the profile's first that stops "
                 "the axis")
      ->check(CLI::Range(0, 65535));
  app.add_flag("--json", arguments.json, "Print the addresses as JSON");
}

int run_program(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Simulates the drive of a rig on Modbus TCP and RTU, on loopback only.");
  app.name("hydroprint-virtual-rig");
  app.footer(kFooter + std::string(action_help()));
  app.set_version_flag("--version", "hydroprint-virtual-rig " HYDROPRINT_VERSION);
  declare(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitStatus::kUsage);
  }
  const auto options = options_of(arguments, app);
  if (!options) return refuse(options.error());
  return run(*options, arguments.json);
}

}  // namespace
}  // namespace hydroprint::simulated_drive

int main(int argc, char** argv) {
  try {
    return hydroprint::simulated_drive::run_program(argc, argv);
  } catch (const std::exception& error) {
    return hydroprint::simulated_drive::refuse(error.what(), hydroprint::ExitStatus::kFailed);
  }
}
