#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <string>

#include "client/calibration.h"
#include "client/cli/commands/commands.h"
#include "client/cli/format/calibration_text.h"
#include "client/cli/format/json.h"
#include "client/cli/job_io/inputs.h"
#include "client/cli/job_io/spec_fields.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/name_of.h"
#include "client/pose_file.h"
#include "client/time.h"

namespace hydroprint::cli {
namespace {

struct EnterOptions {
  v1::Calibration entered;
  std::string mesh, pose;
};

std::string holds(const v1::Calibration& calibration) {
  const std::vector<std::string> why = staleness_of(calibration);
  return why.empty() ? "yes" : fmt::format("{}", fmt::join(why, ","));
}

void print_table(const v1::ListCalibrationsResponse& list) {
  constexpr const char* kRow = "{:<18}{:<8}{:<8}{:<14}{:<21}{}\n";
  std::cout << fmt::format(kRow, "CALIBRATION", "KIND", "ACTIVE", "VALID", "CREATED", "NAME");
  for (const v1::Calibration& one : list.calibrations()) {
    std::cout << fmt::format(
        kRow, one.name(), client::name_of(one.kind()), one.active() ? "yes" : "", holds(one),
        format_time(client::time_of(one.create_time())), printable(one.display_name()));
  }
}

void print_result(const Program& program, const v1::Calibration& calibration) {
  if (program.json())
    print(calibration);
  else
    std::cout << text_of(calibration) << std::flush;
}

Status list(Program& program, int limit) {
  HP_ASSIGN_OR_RETURN(const auto all, client::list_calibrations(program.daemon(), limit));
  if (program.json())
    print(all);
  else
    print_table(all);
  return {};
}

Status show(Program& program, const std::string& name) {
  HP_ASSIGN_OR_RETURN(const v1::Calibration found,
                      client::get_calibration(program.daemon(), calibration_name(name)));
  program.json() ? print(found) : print_tree(tree_of(found));
  return {};
}

Status activate(Program& program, const std::string& name) {
  HP_ASSIGN_OR_RETURN(const v1::Calibration found,
                      client::activate_calibration(program.daemon(), calibration_name(name)));
  print_result(program, found);
  return {};
}

Status remove(Program& program, const std::string& text) {
  const std::string name = calibration_name(text);
  HP_RETURN_IF_ERROR(client::delete_calibration(program.daemon(), name));
  if (program.json())
    print({{"deleted", {name}}});
  else
    std::cout << name << " deleted" << std::endl;
  return {};
}

Status enter(Program& program, const EnterOptions& options) {
  v1::Calibration entered = options.entered;
  HP_ASSIGN_OR_RETURN(*entered.mutable_pose(), client::read_pose_file(options.pose));
  HP_RETURN_IF_ERROR(Inputs(program.daemon()).add_to(entered, "mesh", options.mesh));
  HP_ASSIGN_OR_RETURN(const v1::Calibration calibration,
                      client::create_calibration(program.daemon(), entered));
  print_result(program, calibration);
  return {};
}

CLI::App* add_named(CLI::App& parent, Program& program, const char* verb, const char* help,
                    Status (*action)(Program&, const std::string&)) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = parent.add_subcommand(verb, help);
  command->add_option("calibration", *name, "The calibration: calibrations/3, 3 or active")
      ->type_name("CALIBRATION")
      ->required();
  program.on(*command, [&program, name, action] { return action(program, *name); });
  return command;
}

void add_listing(CLI::App& parent, Program& program) {
  auto limit = std::make_shared<int>(50);
  CLI::App* command = parent.add_subcommand("list", "List calibrations, newest first");
  command->add_option("--limit", *limit, "Maximum number of calibrations")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  program.on(*command, [&program, limit] { return list(program, *limit); });
}

void add_enter(CLI::App& parent, Program& program) {
  auto options = std::make_shared<EnterOptions>();
  CLI::App* command = parent.add_subcommand("enter", "Enter a pose by hand, without a camera");
  command->add_option("--mesh", options->mesh, "Mesh of the object")->type_name("FILE")->required();
  command
      ->add_option(
          "--pose", options->pose,
          R"(JSON file with the pose: {"rotation_wxyz":[w,x,y,z],"translation_mm":[x,y,z]})")
      ->type_name("FILE")
      ->required();
  v1::Calibration& entered = options->entered;
  entered.set_scale(1);
  for (const char* field : {"scale", "film", "display_name"}) add_field(*command, entered, field);
  command->footer(
      "For a rig without a camera: position the object as the placement template shows\n"
      "('hydroprint submit template'). hydroprint cannot detect when the pose becomes invalid.\n\n"
      "Example:\n"
      "  hydroprint calibrations enter --mesh mug.obj --scale 10 --pose held.json");
  program.on(*command, [&program, options] { return enter(program, *options); });
}

}  // namespace

void add_calibrations(CLI::App& app, Program& program) {
  CLI::App* command =
      app.add_subcommand("calibrations", "Manage calibrations of objects and cameras");
  command->require_subcommand(1);
  add_listing(*command, program);
  add_named(*command, program, "show", "Show the details of a calibration", show);
  add_named(*command, program, "activate", "Make a calibration the default of its kind", activate);
  add_named(*command, program, "delete", "Delete a calibration; its job is kept", remove);
  add_enter(*command, program);
}

}  // namespace hydroprint::cli
