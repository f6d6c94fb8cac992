#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/job_io/spec_fields.h"
#include "client/cli/loop/rounds.h"
#include "client/cli/program/program.h"
#include "client/cli/rig_session/held_lease.h"
#include "client/cli/rig_session/motion.h"
#include "client/loop/control.h"
#include "client/loop/report.h"
#include "client/rig.h"
#include "sim/base/artifact_file.h"

namespace hydroprint::cli {
namespace {

/// Arms and homes the axis, also after a fault. On an overloaded machine, the drive's watchdog may
/// stop the axis between two poses, which does no harm.
Status make_ready(Program& program, const HeldLease& lease) {
  HP_ASSIGN_OR_RETURN(v1::Rig rig, client::get_rig(program.daemon()));
  if (!rig.axis().is_virtual())
    return fail(
        Code::kFailedPrecondition,
        "the loop needs a virtual rig; start hydroprint-virtual-rig and connect the daemon to it");
  if (rig.state() == v1::Rig::FAULT) {
    HP_ASSIGN_OR_RETURN(rig, client::reset_rig(program.daemon(), lease.id()));
  }
  if (rig.state() == v1::Rig::DISARMED)
    HP_RETURN_IF_ERROR(client::arm_rig(program.daemon(), lease.id()));
  if (rig.homed()) return {};
  HP_RETURN_IF_ERROR(wait_for_motion(program, client::home_rig(program.daemon(), lease.id())));
  return {};
}

Status write(const loop::Report& report, const std::filesystem::path& folder) {
  HP_RETURN_IF_ERROR(image::write_artifact(folder / "report.html", loop::report_html(report)));
  return image::write_artifact(folder / "report.json", loop::report_json(report));
}

Status run_loop(Program& program, const LoopOptions& options) {
  HP_ASSIGN_OR_RETURN(loop::Body body, loop::make_body(options.object));
  const std::filesystem::path folder(options.out);
  loop::Report report{options.object, loop::bound_mm(body), options.seed, {}, {}};
  HP_RETURN_IF_ERROR(loop::talk(options.control, "show nothing"));  // before anything moves
  HP_ASSIGN_OR_RETURN(const auto lease, HeldLease::take_or_acquire(program, "the loop"));
  HP_RETURN_IF_ERROR(make_ready(program, *lease));
  LoopRounds rounds(program, options, std::move(body), *lease);
  HP_RETURN_IF_ERROR(rounds.prepare());
  report.camera = rounds.camera();
  for (int i = 0; i < options.poses; ++i) {
    HP_RETURN_IF_ERROR(make_ready(program, *lease));
    HP_ASSIGN_OR_RETURN(report.rounds.emplace_back(), rounds.round(i));
    HP_RETURN_IF_ERROR(write(report, folder));
  }
  if (program.json())
    print(Json::parse(loop::report_json(report)));
  else
    std::cout << loop::report_text(report) << (folder / "report.html").string() << std::endl;
  return loop::verdict(report);
}

constexpr char kLoopFooter[] =
    "Calibrates the virtual rig's camera from twelve views of the board. For each pose, hangs the\n"
    "object with a random error, calibrates with the noisy camera, simulates, lays out the page\n"
    "and dips on the rig. A computation then dips that film image at the true pose, with errors "
    "of\n"
    "axis, film and printer, and measures where the picture's cross-points land.\n"
    "The exit status is 4 if the error is above its limit, or if a calibration is too uncertain: "
    "a\n"
    "motion that the scan does not determine, or a stated error above 1 mm.\n"
    "The rig's --scene must have a [camera], and enough space above the water for the object.\n\n"
    "Example:\n"
    "  hydroprint loop --object board --control /tmp/rig --poses 10 --out loop";

}  // namespace

void add_loop(CLI::App& app, Program& program) {
  auto options = std::make_shared<LoopOptions>();
  CLI::App* command = app.add_subcommand(
      "loop", "Measure the placement error of a print in silico, on the virtual rig");
  command->add_option("--object", options->object, "The sample to print")
      ->type_name("OBJECT")
      ->check(CLI::IsMember({"board", "sphere80"}))
      ->capture_default_str();
  command->add_option("--control", options->control, "The virtual rig's --control socket")
      ->type_name("PATH")
      ->required();
  command
      ->add_option("--camera", options->camera,
                   "Use this camera calibration: calibrations/2, 2, a camera.json, or 'active'")
      ->type_name("CALIBRATION");
  command->add_option("--poses", options->poses, "Number of poses")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of the random errors")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "Duration of each capture")
      ->type_name("S")
      ->capture_default_str();
  command->add_option("--dpi", options->dpi, "Resolution of the film image")
      ->type_name("DPI")
      ->capture_default_str();
  add_field(*command, options->simulation, "model");
  command->add_option("--out", options->out, "Folder for report.html, report.json and the pictures")
      ->type_name("DIR")
      ->required();
  command->footer(kLoopFooter);
  program.on(*command, [&program, options] { return run_loop(program, *options); });
}

}  // namespace hydroprint::cli
