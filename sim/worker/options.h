#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/result.h"
#include "sim/fit/fit.h"
#include "sim/pipeline/pipeline.h"
#include "sim/print/print_image.h"
#include "sim/validate/validate.h"

namespace hydroprint::worker {

enum class Verb {
  kSimulate,
  kPredict,
  kFit,
  kValidate,
  kPrintImage,
  kTemplate,
  kCalibrate,
  kCalibrateCamera,
  kFuse,
  kPreview
};

/// Files that print-image writes.
enum class PrintFormat { kPdf, kPng, kTiff };

/// What the command line asks for (contract, "hydroprint-worker simulate" and "predict"), checked
/// as far as that goes without opening a file.
struct Options {
  Verb verb = Verb::kSimulate;
  std::filesystem::path mesh;
  std::filesystem::path texture;     ///< simulate; empty: the model's own colours
  std::filesystem::path film_image;  ///< predict, print-image
  std::filesystem::path motion;      ///< predict; empty: straight down
  validate::Options validate;        ///< validate
  std::filesystem::path points;      ///< fit
  fit::Options fit;                  ///< fit
  print::PrintSettings print;        ///< print-image; its page: template, too
  std::vector<PrintFormat> formats;  ///< print-image
  std::vector<std::filesystem::path>
      frames;                        ///< calibrate, fuse; calibrate-camera: one folder a view
  std::filesystem::path layout;      ///< calibrate; fuse: empty, where there is none
  std::filesystem::path camera;      ///< calibrate, fuse; empty: the driver's lens
  std::optional<double> gripper_mm;  ///< calibrate; none: nobody knows
  double voxel_mm = 3;               ///< fuse
  std::filesystem::path out;
  std::filesystem::path pose;     ///< empty: as in the file, centred
  std::filesystem::path profile;  ///< empty: the defaults of film::Profile
  double scale = 1;
  std::string film = "A4";
  double dpi = 300;
  pipeline::FilmModel film_model = pipeline::FilmModel::kSheet;
  bool inertia = false;
  int ink_passes = 1;
  std::filesystem::path ink_image;  ///< empty: none
  std::optional<double> depth_mm;   ///< none: full
  double dip_speed_mm_per_s = 5;
  int threads = 1;
  bool map_only = false;  ///< --artifacts map
  bool json = false;
  int progress_fd = -1;  ///< -1: none
};

/// What to do with a command line.
struct CommandLine {
  enum class Action { kRun, kPrint, kRefuse };
  Action action = Action::kRun;
  Options options;
  std::string text;  ///< kPrint: help or version
  Error error;       ///< kRefuse
  ExitStatus status = ExitStatus::kDone;
};

/// Reads the command line. Refuses with kUsage what it does not understand, with
/// kBadInput a dpi, scale, depth or speed out of range.
[[nodiscard]] CommandLine parse_command_line(int argc, const char* const* argv);

}  // namespace hydroprint::worker
