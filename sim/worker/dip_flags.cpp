#include "sim/worker/flags.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kSimulateExamples = R"(Examples:
  hydroprint-worker simulate --mesh spot.obj --texture spot.png --scale 50 --out spot-film
  hydroprint-worker simulate --mesh mug.obj --scale 10 --pose pose.json --film A3 --dpi 600 --out mug
  hydroprint-worker simulate --mesh ball.ply --film circle:105 --depth-mm 40 --artifacts map --out map

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr const char* kPredictExamples = R"(Examples:
  hydroprint-worker predict --mesh spot.obj --film-image film.png --scale 50 --out landed
  hydroprint-worker predict --mesh spot.obj --film-image film.png --pose true.json --motion driven.csv --out landed

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr const char* kPreviewExamples =
    R"(For programs: reads the model once, then a request a line on stdin, like
  {"id": 7, "pose": {"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0]}, "film": "A3"}
and answers on stdout where film lands and how far it is stretched, roughly and in a fraction of a second, by a line of
JSON and as many bytes as its "bytes" says (four floats a vertex: film_x, film_y, contact_time, stretch). The model
itself comes first. A newer request ends the one that is being computed. All in sim/worker/preview.h.

Example:
  echo '{"id": 1}' | hydroprint-worker preview --mesh ball.ply | head -n 1

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

/// What goes in which way through which film.
void add_dip(CLI::App& app, Typed& typed) {
  Options& o = typed.options;
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
  add_run(app, o);
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
  add_run(app, o);
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
}

}  // namespace

void add_dip_verbs(CLI::App& program, Typed& typed) {
  Options& o = typed.options;
  CLI::App& simulate =
      add_verb(program, typed, Verb::kSimulate, "simulate",
               "From a textured model to the film image to print", kSimulateExamples);
  add_common(simulate, typed);
  add_path(simulate, "--texture", o.texture,
           "PNG, JPEG or TIFF; default: the model's own materials");

  CLI::App& predict =
      add_verb(program, typed, Verb::kPredict, "predict",
               "From a film image as printed to the colours that land", kPredictExamples);
  add_common(predict, typed);
  add_path(predict, "--film-image", o.film_image, "The film image as printed")->required();
  add_path(predict, "--motion", o.motion, "Path as driven: t_s,x_mm,y_mm,z_mm", "FILE.csv");

  CLI::App& preview = add_verb(program, typed, Verb::kPreview, "preview",
                               "How a dip would roughly go, again and again while a pose changes",
                               kPreviewExamples);
  add_threads(preview, o);
  add_dip(preview, typed);

  add_fit(
      add_verb(program, typed, Verb::kFit, "fit",
               "From measured landing points to the film profile that explains them", kFitExamples),
      typed);
  add_validate(
      add_verb(program, typed, Verb::kValidate, "validate",
               "The paper's experiments in silico, as a report with pictures", kValidateExamples),
      o);
}

}  // namespace hydroprint::worker
