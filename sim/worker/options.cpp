#include "sim/worker/options.h"

#include <fcntl.h>
#include <sched.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/film/outline.h"
#include "sim/image/film_image.h"

namespace hydroprint::worker {
namespace {

constexpr int kMaxThreads = 1024;
constexpr int kMaxInkPasses = 20;

constexpr const char* kSimulateExamples = R"(Examples:
  hydroprint-worker simulate --mesh spot.obj --texture spot.png --scale 50 --out spot-film
  hydroprint-worker simulate --mesh mug.obj --scale 10 --pose pose.json --film A3 --dpi 600 --out mug
  hydroprint-worker simulate --mesh ball.ply --film circle:105 --depth-mm 40 --artifacts map --out map

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr const char* kPredictExamples = R"(Examples:
  hydroprint-worker predict --mesh spot.obj --film-image film.png --scale 50 --out landed
  hydroprint-worker predict --mesh spot.obj --film-image film.png --pose true.json --motion driven.csv --out landed

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr const char* kFitExamples =
    R"(The measured points: film_x_mm,film_y_mm,X_mm,Y_mm,Z_mm, a header and then one point a line: where it was printed on
the film, and where it was found on the object (mesh coordinates after --scale). What the points cannot tell keeps the
value of --profile, and report.json says why.

Examples:
  hydroprint-worker fit --mesh ball.ply --film circle:105 --points measured.csv --ink-image film.png --out fitted
  hydroprint-worker fit --mesh ball.ply --points measured.csv --profile film.toml --free drag,swelling --out fitted
  hydroprint-worker simulate --mesh spot.obj --profile fitted/film_profile.toml --out spot

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr const char* kValidateExamples = R"(Examples:
  hydroprint-worker validate --out validation                         # then open validation/report.html
  hydroprint-worker validate --only accuracy,bowl --quick --out glance

Exit status: 0 done, whatever the figures are; 2 bad usage, 4 the computation failed, 130 cancelled.)";

constexpr const char* kPrintImageExamples =
    R"(Files: print.pdf, pages of the paper's size with registration marks, rulers, an arrow and a line of text wherever
no film is; print.png and print.tif, the film image (of each sheet, where it takes several) alone. Print them at 100 %,
without fitting to the page. The same options give the same files, bit for bit.

Examples:
  hydroprint-worker print-image --film-image film.png --out paper
  hydroprint-worker print-image --film-image film.png --film circle:105 --job-name "mug 7" --date 2025-03-14 --out paper
  hydroprint-worker print-image --film-image film.png --icc-profile printer.icc --ink-limit 3 --formats pdf,tiff --out paper
  hydroprint-worker print-image --film-image film.png --film A3 --paper A4 --overlap-mm 15 --out paper

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr const char* kTemplateExamples =
    R"(placement.pdf: the film's edge and axes, what of the object the water meets first and the silhouette of all of it,
seen from above at exact scale; and a page with pictures of the orientation. For a rig without a camera: print it at
100 %, lay it where the film will float, and bring the object over it.

Example:
  hydroprint-worker template --mesh mug.obj --scale 10 --pose pose.json --job-name "mug 7" --out placement

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr const char* kCalibrateExamples =
    R"(calibration.json: the object's pose in the film frame with its covariance, what the scan does not tell and the
nominal pose does, what became of each marker, and the water's level. pose.json: the pose for simulate --pose.
alignment.png: the scan's points over the mesh by how far they are off; error.png: how well the surface's place is known.

Examples:
  hydroprint-capture --seconds 2 --out frames
  hydroprint-worker calibrate --frames frames --layout rig_layout.toml --camera camera.json --mesh mug.obj --scale 10 --out held
  hydroprint-worker simulate --mesh mug.obj --scale 10 --pose held/pose.json --out film

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr const char* kCalibrateCameraExamples =
    R"(Each view: 1 s of frames of the calibration board (sim/registration), held still, whole in view and 30 mm before what
is behind it; twelve views, tilted each way by 30 degrees, near and far, and out to the corners of the image.

Example:
  hydroprint-worker calibrate-camera --frames view1 view2 view3 view4 view5 view6 --out camera

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr const char* kFuseExamples =
    R"(scan.ply: the surface that a camera saw while it was swept by hand, by volume of signed distances, in mm; with
--layout in the film frame and cut off outside the bars, else in the camera's frame at its first depth frame.
camera_path.csv: where the camera was. Begin with the markers in view, keep 0.6 to 1.2 m away, and take 10 s.

Examples:
  hydroprint-capture --seconds 10 --record sweep.oni --out sweep
  hydroprint-worker fuse --frames sweep --layout rig_layout.toml --camera camera.json --out fused

Exit status: 0 done, 2 bad usage, 3 bad input (the camera was lost among it), 4 the computation failed, 130 cancelled.)";

/// Options as typed: what cannot stand in Options is settled in `settle`.
struct Typed {
  Options options;
  std::string depth = "full";
  std::string model = "sheet";
  std::string artifacts = "all";
  std::vector<std::string> free;
  std::string paper = "A4";
  std::string colours = "rgb";
  std::vector<std::string> formats;
};

int all_cores() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return std::max(1, CPU_COUNT(&set));
}

/// An option that names a file. (Left to itself, the library would cut paths at blanks.)
CLI::Option* add_path(CLI::App& app, const std::string& flag, std::filesystem::path& path,
                      const std::string& description, const std::string& type = "FILE") {
  return app
      .add_option_function<std::string>(
          flag, [&path](const std::string& text) { path = text; }, description)
      ->type_name(type);
}

/// What every verb takes.
void add_run(CLI::App& app, Options& o) {
  add_path(app, "--out", o.out, "Artifact folder to make; one of an earlier run is replaced", "DIR")
      ->required();
  app.add_option("--threads", o.threads, "Threads to compute on; default: all cores");
  app.add_flag("--json", o.json, "Summary or error as one JSON object on stdout");
  app.add_option("--progress-fd", o.progress_fd,
                 "File descriptor to write progress to, one JSON object a line")
      ->type_name("N");
}

void add_validate(CLI::App& app, Options& o) {
  add_run(app, o);
  std::string names;
  for (const auto& kind : validate::kinds()) names += (names.empty() ? "" : ", ") + kind.name;
  app.add_option("--only", o.validate.only, "Experiments to run: " + names + "; default: all")
      ->delimiter(',')
      ->type_name("NAME[,NAME]");
  app.add_flag("--quick", o.validate.quick,
               "A coarse run: that everything works, not how accurate it is");
  app.footer(kValidateExamples);
}

void add_film(CLI::App& app, Options& o) {
  app.add_option("--film", o.film, "A4, A3, letter, WxH, circle:RADIUS (mm) or polygon:FILE.json")
      ->capture_default_str()
      ->type_name("FILM");
}

/// An object as it is held.
void add_object(CLI::App& app, Options& o) {
  add_path(app, "--mesh", o.mesh, "Model: OBJ, STL, PLY, glTF or GLB")->required();
  app.add_option("--scale", o.scale, "Model units to mm")->capture_default_str();
  add_path(app, "--pose", o.pose,
           R"({"rotation_wxyz":[w,x,y,z],"translation_mm":[x,y,z]}; default: as in the file, )"
           "bounding box centred on the film",
           "FILE.json");
}

/// What goes in which way through which film.
void add_dip(CLI::App& app, Typed& typed) {
  Options& o = typed.options;
  add_run(app, o);
  add_object(app, o);
  add_path(app, "--profile", o.profile, "Film profile", "FILE.toml");
  add_film(app, o);
  app.add_option("--depth-mm", typed.depth, "Immersion at the end of the dip")
      ->capture_default_str()
      ->type_name("D|full");
  app.add_option("--dip-speed-mm-per-s", o.dip_speed_mm_per_s, "Speed of the dip")
      ->capture_default_str();
}

/// What simulate and predict have in common.
void add_common(CLI::App& app, Typed& typed) {
  Options& o = typed.options;
  add_dip(app, typed);
  app.add_option("--dpi", o.dpi, "Resolution of the film image")->capture_default_str();
  app.add_option("--model", typed.model,
                 "How the film moves: as a viscous sheet or as Stokes flow, faster and good while "
                 "the film is stretched less than 1.3 times")
      ->capture_default_str()
      ->type_name("sheet|stokes");
  app.add_flag("--inertia", o.inertia,
               "The sheet moves with inertia (Young's modulus, density and Poisson's ratio of the "
               "profile): slower, the same answer but for Poisson's ratio");
  app.add_option("--ink-passes", o.ink_passes,
                 "Passes that take the thickness of the image's own ink into account; 0: none. For "
                 "the sheet alone")
      ->capture_default_str();
  add_path(app, "--ink-image", o.ink_image,
           "What is printed on the film, in place of --ink-passes: an RGB film image", "FILE.png");
  app.add_option("--artifacts", typed.artifacts, "map: the map and report.json only")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "map"}));
}

void add_fit(CLI::App& app, Typed& typed) {
  Options& o = typed.options;
  add_dip(app, typed);
  add_path(app, "--points", o.points, "Measured landing points", "FILE.csv")->required();
  add_path(app, "--ink-image", o.ink_image,
           "What was printed on the film: an RGB film image. Without it the ink ratio cannot be "
           "fitted",
           "FILE.png");
  app.add_option("--free", typed.free,
                 "What to fit: ink_ratio, drag, swelling; default: all that the points determine")
      ->delimiter(',')
      ->type_name("NAME[,NAME]");
  app.add_flag("--drop-outliers", o.fit.drop_outliers,
               "Leave out points beyond 4 robust standard deviations; else they are only named");
  app.footer(kFitExamples);
}

/// The paper, and what stands on it.
void add_page(CLI::App& app, Typed& typed) {
  print::PageSettings& page = typed.options.print.page;
  app.add_option("--paper", typed.paper, "A4, A3, letter or WxH (mm)")
      ->capture_default_str()
      ->type_name("PAPER");
  app.add_option("--printer-margin-mm", page.printer_margin_mm,
                 "What the printer cannot print along the edges of the paper")
      ->capture_default_str();
  app.add_option("--job-name", page.job_name, "Printed beside the film")->type_name("TEXT");
  app.add_option("--date", page.date, "Printed beside the film, as given")->type_name("TEXT");
}

void add_print_image(CLI::App& app, Typed& typed) {
  Options& o = typed.options;
  print::PageSettings& page = o.print.page;
  add_run(app, o);
  add_path(app, "--film-image", o.film_image, "The film image: film.png of simulate")->required();
  add_film(app, o);
  app.add_option("--dpi", o.print.dpi,
                 "Resolution of the film image; default: the whole number that its size means")
      ->type_name("FLOAT");
  add_page(app, typed);
  app.add_option("--bar-mm", page.bar_mm,
                 "Length of the sliding bars that hold the film, for marks at their ends; 0: at "
                 "their middles alone")
      ->capture_default_str();
  app.add_option("--overlap-mm", page.overlap_mm,
                 "What neighbouring sheets have in common where the film takes several")
      ->capture_default_str();
  app.add_flag("--mirror", page.mirror,
               "Print it mirrored; else it is seen from above, ink side up");
  app.add_flag("!--no-marks", page.marks, "Nothing but the film image");
  app.add_option("--colours", typed.colours, "rgb: sRGB; cmyk: plain CMYK")
      ->capture_default_str()
      ->check(CLI::IsMember({"rgb", "cmyk"}));
  add_path(app, "--icc-profile", o.print.colours.icc_profile,
           "The printer's ICC output profile, CMYK or RGB, in place of --colours", "FILE.icc");
  app.add_option("--ink-limit", o.print.colours.ink_limit,
                 "Most C + M + Y + K of a pixel; for CMYK alone")
      ->capture_default_str();
  app.add_option("--formats", typed.formats,
                 "pdf, png, tiff; default: pdf, and png for RGB or tiff for CMYK")
      ->delimiter(',')
      ->type_name("FORMAT[,FORMAT]");
  app.footer(kPrintImageExamples);
}

void add_template(CLI::App& app, Typed& typed) {
  add_run(app, typed.options);
  add_object(app, typed.options);
  add_film(app, typed.options);
  add_page(app, typed);
  app.footer(kTemplateExamples);
}

/// Folders that hydroprint-capture wrote.
CLI::Option* add_frames(CLI::App& app, Options& o, const std::string& description) {
  return app
      .add_option_function<std::vector<std::string>>(
          "--frames",
          [&o](const std::vector<std::string>& folders) {
            o.frames.assign(folders.begin(), folders.end());
          },
          description)
      ->required()
      ->type_name("DIR");
}

void add_calibrate(CLI::App& app, Options& o) {
  add_run(app, o);
  add_frames(app, o, "Depth frames: a folder of hydroprint-capture")->expected(1);
  add_path(app, "--layout", o.layout, "The rig's markers and camera", "FILE.toml")->required();
  add_path(app, "--camera", o.camera,
           "The camera's lens, of calibrate-camera; default: what its driver says", "FILE.json");
  add_object(app, o);
  add_film(app, o);
  app.add_option("--gripper-mm", o.gripper_mm,
                 "Height of the gripper's lower end over the water, which holds the object's top; "
                 "default: there is none in view");
  app.footer(kCalibrateExamples);
}

void add_fuse(CLI::App& app, Options& o) {
  add_run(app, o);
  add_frames(app, o, "Depth frames of a camera swept by hand: a folder of hydroprint-capture")
      ->expected(1);
  add_path(app, "--layout", o.layout, "The rig's markers and camera", "FILE.toml");
  add_path(app, "--camera", o.camera,
           "The camera's lens, of calibrate-camera; default: what its driver says", "FILE.json");
  app.add_option("--voxel-mm", o.voxel_mm, "How fine the volume is")->capture_default_str();
  app.footer(kFuseExamples);
}

void add_calibrate_camera(CLI::App& app, Options& o) {
  add_run(app, o);
  add_frames(app, o, "Views of the board: folders of hydroprint-capture")->expected(1, -1);
  app.footer(kCalibrateCameraExamples);
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
  if (o.out.empty()) return "--out: empty. Name a folder";
  return {};
}

/// Takes what print-image and template say of paper and files; refuses what makes no sense.
Status settle_print(Typed& typed) {
  Options& o = typed.options;
  if (o.verb == Verb::kPrintImage && o.film_image.empty()) {
    return fail(Code::kInvalidArgument, "--film-image: empty. Name a file");
  }
  o.print.colours.cmyk = typed.colours == "cmyk";
  const std::vector<std::string> names = {"pdf", "png", "tiff"};
  for (const std::string& name : typed.formats) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      return fail(Code::kInvalidArgument,
                  "--formats: '" + name + "' is unknown. Use pdf, png or tiff");
    }
    const auto format = static_cast<PrintFormat>(found - names.begin());
    if (std::find(o.formats.begin(), o.formats.end(), format) == o.formats.end()) {
      o.formats.push_back(format);
    }
  }
  HP_ASSIGN_OR_RETURN(o.print.page.paper_mm, print::parse_paper(typed.paper));
  return print::check(o.print.page);
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
  CLI::App* simulate =
      app.add_subcommand("simulate", "From a textured model to the film image to print");
  add_common(*simulate, typed);
  add_path(*simulate, "--texture", typed.options.texture,
           "PNG, JPEG or TIFF; default: the model's own materials");
  simulate->footer(kSimulateExamples);

  CLI::App* predict =
      app.add_subcommand("predict", "From a film image as printed to the colours that land");
  add_common(*predict, typed);
  add_path(*predict, "--film-image", typed.options.film_image, "The film image as printed")
      ->required();
  add_path(*predict, "--motion", typed.options.motion, "Path as driven: t_s,x_mm,y_mm,z_mm",
           "FILE.csv");
  predict->footer(kPredictExamples);

  CLI::App* fit = app.add_subcommand(
      "fit", "From measured landing points to the film profile that explains them");
  add_fit(*fit, typed);

  CLI::App* print_image = app.add_subcommand(
      "print-image", "From a film image to the files to print, at exact scale on paper");
  add_print_image(*print_image, typed);

  CLI::App* placement = app.add_subcommand(
      "template", "A page that shows where the object belongs, for a rig without a camera");
  add_template(*placement, typed);

  CLI::App* calibrate = app.add_subcommand(
      "calibrate",
      "From depth frames to the object's pose over the film, and how well it is known");
  add_calibrate(*calibrate, typed.options);

  CLI::App* calibrate_camera = app.add_subcommand(
      "calibrate-camera", "From views of the calibration board to a camera's lens and depth scale");
  add_calibrate_camera(*calibrate_camera, typed.options);

  CLI::App* fuse = app.add_subcommand(
      "fuse", "From depth frames of a camera swept by hand to the surface that they show");
  add_fuse(*fuse, typed.options);

  CLI::App* validate = app.add_subcommand(
      "validate", "The paper's experiments in silico, as a report with pictures");
  add_validate(*validate, typed.options);

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
  typed.options.verb = predict->parsed() ? Verb::kPredict : Verb::kSimulate;
  if (fit->parsed()) typed.options.verb = Verb::kFit;
  if (validate->parsed()) typed.options.verb = Verb::kValidate;
  if (placement->parsed()) typed.options.verb = Verb::kTemplate;
  if (calibrate->parsed()) typed.options.verb = Verb::kCalibrate;
  if (calibrate_camera->parsed()) typed.options.verb = Verb::kCalibrateCamera;
  if (fuse->parsed()) typed.options.verb = Verb::kFuse;
  if (print_image->parsed()) typed.options.verb = Verb::kPrintImage;
  return settle(typed);
}

}  // namespace hydroprint::worker
