#include "hardware/capture/options.h"

#include <CLI/CLI.hpp>
#include <sstream>

namespace hydroprint::capture {
namespace {

constexpr const char* kFooter = R"(Examples:
  hydroprint-capture --seconds 2 --out frames                                  # the camera that is plugged in
  hydroprint-capture --device hydroprint:/tmp/rig --seconds 10 --record sweep.oni --out frames
  hydroprint-capture --recording sweep.oni --out frames
  hydroprint-capture --live                    # one line of JSON and one PNG, every second

Exit status: 0 done, 2 bad usage, 3 bad input (such as an unknown camera), 4 the camera failed, 130 cancelled.)";

/// Adds an option for a file. CLI11's own conversion would cut paths at spaces.
CLI::Option* add_path(CLI::App& app, const std::string& flag, std::filesystem::path& path,
                      const std::string& description, const std::string& type) {
  return app
      .add_option_function<std::string>(
          flag, [&path](const std::string& text) { path = text; }, description)
      ->type_name(type);
}

void declare(CLI::App& app, Options& o) {
  auto* device =
      app.add_option("--device", o.device,
                     "OpenNI2 name of the camera; hydroprint:CONTROL for a virtual rig; default: "
                     "the first camera")
          ->type_name("URI");
  auto* recording = add_path(app, "--recording", o.recording,
                             "Use the frames of this recording instead of a camera", "FILE.oni");
  auto* record =
      add_path(app, "--record", o.record, "Also save the depth stream as a recording", "FILE.oni");
  recording->excludes(device)->excludes(record);
  auto* out = add_path(
      app, "--out", o.out,
      "Folder to create for the frames and frames.json; replaces that of an earlier run", "DIR");
  auto* seconds = app.add_option("--seconds", o.seconds,
                                 "Duration in seconds; default: 2 for a camera, all of a recording")
                      ->check(CLI::Range(0.01, kMostSeconds));
  auto* live = app.add_flag("--live", o.live,
                            "Write pictures to stdout until a signal ends the program, instead of "
                            "frames to a folder");
  live->excludes(recording)->excludes(record)->excludes(out)->excludes(seconds);
  app.add_option("--every-s", o.every_s, "Interval between pictures, in seconds")
      ->check(CLI::Range(0.05, 60.0))
      ->capture_default_str()
      ->needs(live);
  app.add_option("--patience-s", o.patience_s, "Seconds to wait for a camera that does not respond")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  app.add_flag("--json", o.json, "Print the summary or error as one JSON object on stdout");
  app.add_option("--progress-fd", o.progress_fd,
                 "File descriptor for progress, one JSON object per line")
      ->type_name("N");
}

}  // namespace

CommandLine parse_command_line(int argc, char** argv) {
  CommandLine out;
  CLI::App app("Captures frames of a depth camera, or of a recording, as 16-bit PNG files in mm.");
  app.name("hydroprint-capture");
  app.footer(kFooter);
  app.set_version_flag("--version", "hydroprint-capture " HYDROPRINT_VERSION);
  declare(app, out.options);
  try {
    app.parse(argc, argv);
    if (!out.options.live && out.options.out.empty()) throw CLI::RequiredError("--out or --live");
    out.runs = true;
  } catch (const CLI::ParseError& error) {
    std::ostringstream output, errors;
    const bool fine = app.exit(error, output, errors) == 0;
    out.status = fine ? 0 : static_cast<int>(ExitStatus::kUsage);
    out.text = fine ? output.str() : errors.str();
  }
  return out;
}

}  // namespace hydroprint::capture
