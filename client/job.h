#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/dip.h"
#include "client/time.h"

namespace hydroprint::client {

/// The kinds of computation, named after the worker's verbs.
enum class Verb {
  kSimulate,
  kPredict,
  kFit,
  kValidate,
  kPrintImage,
  kTemplate,
  kCalibrate,
  kCalibrateCamera
};

/// "simulate", "print-image", ... as in the worker; the API's Job has "_" in place of "-".
[[nodiscard]] std::string_view name_of(Verb verb);

/// Uploaded bytes and the file name under which the computation sees them.
struct InputFile {
  std::string name;   ///< plain file name or relative path
  std::string asset;  ///< "assets/{sha256}"
};

/// Rigid transform X_FO at the start of the dip; the fields are the keys of the worker's `--pose`
/// file.
struct PoseSpec {
  std::array<double, 4> rotation_wxyz = {1, 0, 0, 0};
  std::array<double, 3> translation_mm = {0, 0, 0};
};

/// The page layout. Used by print-image; template uses the fields up to `date`.
struct PageSpec {
  std::optional<std::string> paper;
  std::optional<double> printer_margin_mm;
  std::string job_name;
  std::string date;
  std::optional<double> bar_mm;
  std::optional<double> overlap_mm;
  bool mirror = false;
  bool no_marks = false;
  std::optional<std::string> colours;  ///< "rgb" or "cmyk"
  std::optional<InputFile> icc_profile;
  std::optional<double> ink_limit;
  std::vector<std::string> formats;  ///< "pdf", "png", "tiff"; empty: the worker's default
};

/// Input of calibrate and calibrate-camera.
struct ScanSpec {
  std::vector<std::string> capture_jobs;  ///< "jobs/5"; calibrate takes exactly one
  std::vector<InputFile> frames;          ///< instead of capture jobs: "view1/frames.json", ...
  std::optional<InputFile> layout;        ///< calibrate only; nullopt: the daemon's
  std::string camera_calibration;   ///< calibrate only: "calibrations/2"; empty: the active one
  std::optional<InputFile> camera;  ///< instead of `camera_calibration`
  std::optional<double> gripper_mm;
};

/// The specification of a computation: the worker's flags (contract). Unset fields keep the
/// worker's defaults.
struct Spec {
  Verb verb = Verb::kSimulate;
  /// Print-image and template only: "jobs/7". Its film image or object replaces the files, `scale`,
  /// `pose`, `film` and `dpi` here. Empty: not used.
  std::string simulate_job;
  InputFile mesh;                       ///< not in validate, print-image, calibrate-camera
  std::vector<InputFile> extra_files;   ///< files that others refer to by name
  std::optional<InputFile> texture;     ///< simulate only
  std::optional<InputFile> film_image;  ///< required by predict and print-image; not used otherwise
  std::optional<InputFile> motion;      ///< predict only
  std::optional<InputFile> points;      ///< required by fit; not used otherwise
  std::optional<InputFile> profile;
  std::optional<InputFile> ink_image;
  std::optional<double> scale;
  std::optional<PoseSpec> pose;
  std::optional<std::string> film;
  std::optional<double> dpi;
  std::optional<std::string> model;  ///< "sheet" or "stokes"
  bool inertia = false;              ///< sheet model only
  std::optional<int> ink_passes;
  std::optional<double> depth_mm;
  std::optional<double> dip_speed_mm_per_s;
  std::optional<int> threads;
  std::optional<std::string> artifacts;  ///< "all" or "map"
  std::vector<std::string> only;         ///< validate only: names of experiments; empty: all
  bool quick = false;                    ///< validate only
  std::vector<std::string> free;         ///< fit only: parameters to fit; empty: all
  bool drop_outliers = false;            ///< fit only
  PageSpec page;                         ///< print-image and template only
  ScanSpec scan;                         ///< calibrate and calibrate-camera only
  /// Simulate only: "calibrations/3", which supplies pose, film and scale; empty: none.
  std::string calibration;
  bool allow_stale_calibration = false;  ///< simulate only
};

enum class JobState {
  kUnknown,
  kQueued,
  kWaitingForOperator,
  kRunning,
  kCancelling,
  kSucceeded,
  kFailed,
  kCancelled,
  kInterrupted
};

/// "QUEUED", "RUNNING", ... as in the API; "UNKNOWN" for values that this client does not know.
[[nodiscard]] std::string_view name_of(JobState state);

/// The reason why a job failed.
struct JobError {
  std::string code;     ///< gRPC's name, for example "INVALID_ARGUMENT" for bad input
  std::string reason;   ///< stable identifier
  std::string message;  ///< one line: the fault, its place and the remedy
  std::optional<int> exit_status;
  std::optional<int> signal;
};

/// A job as the daemon describes it; the fields are those of the API's Job.
struct Job {
  std::string name;  ///< "jobs/7"
  std::string uid;
  std::string display_name;
  std::string owner;
  int priority = 0;
  std::map<std::string, std::string> labels;
  JobState state = JobState::kUnknown;
  double progress_fraction = 0;  ///< [0, 1]
  std::string phase;
  std::optional<Time> eta_time;
  std::optional<Time> create_time;
  std::optional<Time> start_time;
  std::optional<Time> end_time;
  std::optional<JobError> error;
  std::string retry_of;
  std::string input_digest;
  bool cache_hit = false;
  bool shared = false;  ///< whether every user with read access sees its artifacts and files
  bool pinned = false;  ///< exempt from retention
  std::optional<Time> purge_time;  ///< when retention deletes it, if it is finished and not pinned
  std::optional<Spec> spec;  ///< of a computation; nullopt for kinds that this client does not know
  std::optional<DipSpec> dip;                  ///< of a dip
  std::optional<DipStatus> dip_status;         ///< of an unfinished dip
  std::optional<std::string> print_image_job;  ///< of a print: "jobs/7", whose pages are printed
  std::optional<double> capture_s;             ///< of a capture; 0: the default
};

/// Whether the job's state can no longer change.
[[nodiscard]] bool is_finished(const Job& job);

/// Whether every job in that state is finished. INTERRUPTED ends only dips, prints and captures.
[[nodiscard]] bool is_finished(JobState state);

/// One event in a job's history.
struct JobEvent {
  std::int64_t seq = 0;
  std::optional<Time> time;
  std::string job;
  std::string kind;  ///< "STATE_CHANGED", "PROGRESS", "MOVED"
  JobState state = JobState::kUnknown;
  double progress_fraction = 0;  ///< of the whole job, [0, 1]
  std::string phase;
  double phase_fraction = 0;  ///< of that stage, [0, 1]
  std::optional<Time> eta_time;
  std::string message;
};

}  // namespace hydroprint::client
