#include "sim/worker/flags.h"

namespace hydroprint::worker {

CLI::Option* add_path(CLI::App& app, const std::string& flag, std::filesystem::path& path,
                      const std::string& description, const std::string& type) {
  return app
      .add_option_function<std::string>(
          flag, [&path](const std::string& text) { path = text; }, description)
      ->type_name(type);
}

CLI::App& add_verb(CLI::App& program, Typed& typed, Verb verb, const char* name,
                   const char* description, const char* examples) {
  CLI::App* const app = program.add_subcommand(name, description);
  app->footer(examples);
  app->callback([&typed, verb] { typed.options.verb = verb; });
  return *app;
}

void add_threads(CLI::App& app, Options& o) {
  app.add_option("--threads", o.threads, "Threads to compute on; default: all cores");
}

void add_run(CLI::App& app, Options& o) {
  add_path(app, "--out", o.out, "Artifact folder to make; one of an earlier run is replaced", "DIR")
      ->required();
  add_threads(app, o);
  app.add_flag("--json", o.json, "Summary or error as one JSON object on stdout");
  app.add_option("--progress-fd", o.progress_fd,
                 "File descriptor to write progress to, one JSON object a line")
      ->type_name("N");
}

void add_film(CLI::App& app, Options& o) {
  app.add_option("--film", o.film, "A4, A3, letter, WxH, circle:RADIUS (mm) or polygon:FILE.json")
      ->capture_default_str()
      ->type_name("FILM");
}

void add_object(CLI::App& app, Options& o) {
  add_path(app, "--mesh", o.mesh, "Model: OBJ, STL, PLY, glTF or GLB")->required();
  app.add_option("--scale", o.scale, "Model units to mm")->capture_default_str();
  add_path(app, "--pose", o.pose,
           R"({"rotation_wxyz":[w,x,y,z],"translation_mm":[x,y,z]}; default: as in the file, )"
           "bounding box centred on the film",
           "FILE.json");
}

}  // namespace hydroprint::worker
