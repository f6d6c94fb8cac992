#include "sim/worker/options.h"

#include <fcntl.h>
#include <sched.h>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <string_view>
#include <utility>

#include "sim/film/outline.h"
#include "sim/image/film_image.h"
#include "sim/worker/flags.h"

namespace hydroprint::worker {
namespace {

constexpr int kMaxThreads = 1024;
constexpr int kMaxInkPasses = 20;

int all_cores() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return std::max(1, CPU_COUNT(&set));
}

CommandLine refuse(const Options& options, ExitStatus status, Code code, std::string message) {
  CommandLine out;
  out.action = CommandLine::Action::kRefuse;
  out.options = options;
  out.status = status;
  out.error = {code, std::move(message), {}, {}};
  return out;
}

/// What is wrong with the values as such; empty if nothing is.
std::string usage_objection(const Typed& typed) {
  const Options& o = typed.options;
  if (typed.model != "stokes" && typed.model != "sheet") {
    return "--model: '" + typed.model + "' is unknown. Use sheet or stokes";
  }
  if (o.inertia && typed.model == "stokes") {
    return "--inertia: Stokes flow has none. Use it with --model sheet";
  }
  if (o.ink_passes < 0 || o.ink_passes > kMaxInkPasses) {
    return "--ink-passes: out of range. Use 0 to " + std::to_string(kMaxInkPasses);
  }
  if (o.threads < 1 || o.threads > kMaxThreads) {
    return "--threads: out of range. Use 1 to " + std::to_string(kMaxThreads);
  }
  if (o.progress_fd != -1 && (o.progress_fd < 0 || fcntl(o.progress_fd, F_GETFD) == -1)) {
    return "--progress-fd: not an open file descriptor. Open it before";
  }
  const bool has_mesh = o.verb != Verb::kValidate && o.verb != Verb::kPrintImage &&
                        o.verb != Verb::kCalibrateCamera && o.verb != Verb::kFuse;
  if (has_mesh && o.mesh.empty()) return "--mesh: empty. Name a file";
  if (const Status known = validate::check(o.validate); !known) {
    return "--only: " + known.error().message;
  }
  if (o.verb == Verb::kFit && o.points.empty()) return "--points: empty. Name a file";
  if (const auto free = fit::parse_parameters(typed.free); !free) {
    return "--free: " + free.error().message;
  }
  if (o.out.empty() && o.verb != Verb::kPreview) return "--out: empty. Name a folder";
  return {};
}

std::string range_objection(const Options& o) {
  struct Quantity {
    const char* flag;
    double value, least, most;
  };
  for (const Quantity& q : {Quantity{"--scale", o.scale, 1e-6, 1e6},
                            Quantity{"--dpi", o.dpi, image::kMinDpi, image::kMaxDpi},
                            Quantity{"--dip-speed-mm-per-s", o.dip_speed_mm_per_s, 1e-3, 1000},
                            Quantity{"--depth-mm", o.depth_mm.value_or(1), 1e-3, 1e4},
                            Quantity{"--voxel-mm", o.voxel_mm, 1.5, 4},
                            Quantity{"--gripper-mm", o.gripper_mm.value_or(0), -1e4, 1e4}}) {
    if (q.value >= q.least && q.value <= q.most) continue;
    std::ostringstream out;
    out << q.flag << ": " << q.value << " is out of range. Use " << q.least << " to " << q.most;
    return out.str();
  }
  return {};
}

/// Refuses a film that is not a file's but makes no sense or is out of range.
CommandLine check_film(const Options& o) {
  CommandLine accepted;
  accepted.options = o;
  if (film::polygon_file(o.film)) return accepted;
  const auto outline = film::parse_outline(o.film);
  if (outline) return accepted;
  const bool out_of_range = outline.error().code == Code::kOutOfRange;
  return refuse(o, out_of_range ? ExitStatus::kBadInput : ExitStatus::kUsage, outline.error().code,
                "--film: " + outline.error().message);
}

bool parse_depth(Typed& typed) {
  if (typed.depth == "full") return true;
  double depth_mm = 0;
  const char* end = typed.depth.data() + typed.depth.size();
  const auto parsed = std::from_chars(typed.depth.data(), end, depth_mm);
  if (parsed.ec != std::errc() || parsed.ptr != end) return false;
  typed.options.depth_mm = depth_mm;
  return true;
}

CommandLine settle(Typed& typed) {
  const Options& o = typed.options;
  if (const std::string what = usage_objection(typed); !what.empty()) {
    return refuse(o, ExitStatus::kUsage, Code::kInvalidArgument, what);
  }
  if (!parse_depth(typed)) {
    return refuse(o, ExitStatus::kUsage, Code::kInvalidArgument,
                  "--depth-mm: '" + typed.depth + "' is not a number. Give mm, or full");
  }
  if (o.verb == Verb::kPrintImage || o.verb == Verb::kTemplate) {
    if (const Status settled = settle_print(typed); !settled) {
      const bool out_of_range = settled.error().code == Code::kOutOfRange;
      return refuse(o, out_of_range ? ExitStatus::kBadInput : ExitStatus::kUsage,
                    settled.error().code, settled.error().message);
    }
  }
  typed.options.map_only = typed.artifacts == "map";
  typed.options.fit.free = fit::parse_parameters(typed.free).value();
  typed.options.fit.points_name = o.points.string();
  typed.options.film_model =
      typed.model == "sheet" ? pipeline::FilmModel::kSheet : pipeline::FilmModel::kStokes;
  if (const std::string what = range_objection(o); !what.empty()) {
    return refuse(o, ExitStatus::kBadInput, Code::kOutOfRange, what);
  }
  return check_film(o);
}

CommandLine print(std::string text) {
  CommandLine out;
  out.action = CommandLine::Action::kPrint;
  out.text = std::move(text);
  return out;
}

}  // namespace

CommandLine parse_command_line(int argc, const char* const* argv) {
  CLI::App app(
      "Computes one hydrographic print: reads a model, writes an artifact folder.\n"
      "Needs no daemon and no network.");
  app.name("hydroprint-worker");
  app.set_version_flag("--version", "hydroprint-worker " HYDROPRINT_VERSION);
  app.require_subcommand(1);

  Typed typed;
  typed.options.threads = all_cores();
  add_dip_verbs(app, typed);
  add_print_verbs(app, typed);
  add_sight_verbs(app, typed);

  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForVersion&) {
    return print(std::string("hydroprint-worker ") + HYDROPRINT_VERSION + "\n");
  } catch (const CLI::CallForHelp&) {
    return print(app.help());
  } catch (const CLI::CallForAllHelp&) {
    return print(app.help());
  } catch (const CLI::ParseError& error) {
    // The library stops at the first error, and may not have come to this flag.
    typed.options.json = std::find(argv, argv + argc, std::string_view("--json")) != argv + argc;
    return refuse(typed.options, ExitStatus::kUsage, Code::kInvalidArgument,
                  std::string(error.what()) + ". See --help");
  }
  return settle(typed);
}

}  // namespace hydroprint::worker
