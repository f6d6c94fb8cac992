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

/// The kinds of computation, as the worker's verbs.
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

/// "simulate", "print-image", ... as the worker has them; the API's Job has "_" for "-".
[[nodiscard]] std::string_view name_of(Verb verb);

/// Uploaded bytes and the name by which the computation sees them.
struct InputFile {
  std::string name;   ///< plain file name or relative path
  std::string asset;  ///< "assets/{sha256}"
};

/// Rigid transform X_FO at the start of the dip; keys of the worker's `--pose` file.
struct PoseSpec {
  std::array<double, 4> rotation_wxyz = {1, 0, 0, 0};
  std::array<double, 3> translation_mm = {0, 0, 0};
};

/// The paper, and what stands on it: print-image, and template as far as `date`.
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
  std::vector<std::string> formats;  ///< "pdf", "png", "tiff"; none: the worker's
};

/// What calibrate and calibrate-camera are computed from.
struct ScanSpec {
  std::vector<std::string> capture_jobs;  ///< "jobs/5"; of calibrate one
  std::vector<InputFile> frames;          ///< in their place: "view1/frames.json", ...
  std::optional<InputFile> layout;        ///< calibrate only; none: the daemon's
  std::string camera_calibration;   ///< calibrate only: "calibrations/2"; empty: the active one
  std::optional<InputFile> camera;  ///< in its place
  std::optional<double> gripper_mm;
};

/// What a job computes: the worker's flags (contract). What is not set is left to the worker.
struct Spec {
  Verb verb = Verb::kSimulate;
  /// Print-image and template only: "jobs/7", whose film image, or object, is taken, in place of
  /// the files, `scale`, `pose`, `film` and `dpi` here; empty: none.
  std::string simulate_job;
  InputFile mesh;                       ///< all but validate, print-image and calibrate-camera
  std::vector<InputFile> extra_files;   ///< files that others refer to by name
  std::optional<InputFile> texture;     ///< simulate only
  std::optional<InputFile> film_image;  ///< predict and print-image only, and needed there
  std::optional<InputFile> motion;      ///< predict only
  std::optional<InputFile> points;      ///< fit only, and needed there
  std::optional<InputFile> profile;
  std::optional<InputFile> ink_image;
  std::optional<double> scale;
  std::optional<PoseSpec> pose;
  std::optional<std::string> film;
  std::optional<double> dpi;
  std::optional<std::string> model;  ///< "sheet" or "stokes"
  bool inertia = false;              ///< of the sheet alone
  std::optional<int> ink_passes;
  std::optional<double> depth_mm;
  std::optional<double> dip_speed_mm_per_s;
  std::optional<int> threads;
  std::optional<std::string> artifacts;  ///< "all" or "map"
  std::vector<std::string> only;         ///< validate only: names of experiments; none: all
  bool quick = false;                    ///< validate only
  std::vector<std::string> free;         ///< fit only: what to fit; none: all that can be
  bool drop_outliers = false;            ///< fit only
  PageSpec page;                         ///< print-image and template only
  ScanSpec scan;                         ///< calibrate and calibrate-camera only
  /// Simulate only: "calibrations/3", whose pose, film and scale are taken; empty: none.
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

/// "QUEUED", "RUNNING", ... as in the API; "UNKNOWN" for what this client does not know.
[[nodiscard]] std::string_view name_of(JobState state);

/// Why a job failed.
struct JobError {
  std::string code;     ///< gRPC's name, "INVALID_ARGUMENT" when the input is at fault
  std::string reason;   ///< stable word
  std::string message;  ///< one line: what, where, and what to do
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
  bool shared = false;             ///< whether all who may look see its artifacts and files
  bool pinned = false;             ///< whether it is kept beyond its time
  std::optional<Time> purge_time;  ///< when it will be deleted, if it is finished and not kept
  std::optional<Spec> spec;  ///< of a computation; none if of a kind that this client does not know
  std::optional<DipSpec> dip;                  ///< of a dip
  std::optional<DipStatus> dip_status;         ///< of an open dip
  std::optional<std::string> print_image_job;  ///< of a print: "jobs/7", whose pages are printed
  std::optional<double> capture_s;             ///< of a capture: how long; 0: the daemon's default
};

/// Whether the job's state will not change any more.
[[nodiscard]] bool is_finished(const Job& job);

/// Whether this is so of every job in that state: INTERRUPTED is the end of dips, prints
/// and captures alone.
[[nodiscard]] bool is_finished(JobState state);

/// Something that happened to a job.
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
