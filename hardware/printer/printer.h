#pragma once

#include <Eigen/Core>
#include <chrono>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "hardware/printer/address.h"
#include "sim/base/result.h"

namespace hydroprint::printer {

/// Timeouts for a printer.
struct Timing {
  std::chrono::milliseconds connect{5000};
  std::chrono::milliseconds answer{15000};   ///< timeout for a response to one request
  std::chrono::milliseconds upload{300000};  ///< timeout for sending a document and its response
  std::chrono::milliseconds poll{1000};      ///< interval between polls of a job
  /// If a printer does not respond for this long during a job, it counts as lost.
  std::chrono::milliseconds patience{20000};
  std::chrono::milliseconds job{3600000};  ///< timeout of follow(), until the job ends
};

/// A paper size supported by the printer.
struct Paper {
  std::string name;  ///< PWG 5101.1: "iso_a4_210x297mm"
  Eigen::Vector2d size_mm = Eigen::Vector2d::Zero();
};

/// Attributes reported by the printer.
struct Attributes {
  std::string name, make_and_model;
  std::string state;                       ///< "idle", "processing", "stopped"
  std::vector<std::string> state_reasons;  ///< for example "media-empty"; empty: none
  bool accepts_jobs = false;
  std::vector<std::string> formats;  ///< MIME types
  std::vector<Paper> papers;
  /// Smallest margins at the left, right, top and bottom of the paper, mm; 0: prints to the edge.
  Eigen::Vector4d margins_mm = Eigen::Vector4d::Zero();
};

/// A document to print.
struct PrintJob {
  std::span<const unsigned char> document;
  std::string format = "application/pdf";
  std::string name = "Hydroprint";
  Eigen::Vector2d paper_mm = {210, 297};  ///< size of the paper in the tray
};

/// States of a job; see RFC 8011, section 5.3.7.
enum class JobState { kPending, kHeld, kProcessing, kStopped, kCanceled, kAborted, kCompleted };

[[nodiscard]] const char* job_state_name(JobState state);
[[nodiscard]] bool is_over(JobState state);

struct JobReport {
  int id = 0;
  JobState state = JobState::kPending;
  std::vector<std::string> reasons;  ///< for example "aborted-by-system"
  /// Set by follow() only: the printer's state reasons, for example "media-empty".
  std::vector<std::string> printer_reasons;
  int pages_done = 0;  ///< sides printed, if the printer counts them
  bool operator==(const JobReport&) const = default;
};

/// The result of sending a job.
struct Submitted {
  int id = 0;
  /// Attributes that the printer ignores. If "print-scaling" is one of them, the print may not be
  /// at exact scale.
  std::vector<std::string> ignored;
};

/// A printer that supports IPP (RFC 8010, RFC 8011); every call opens its own connection. Immutable
/// and thread-safe. All calls end in bounded time (Timing). If communication fails, they return
/// kUnavailable, reason PRINTER_UNREACHABLE, PRINTER_SILENT, PRINTER_LOST or PRINTER_NOT_IPP. If
/// the printer rejects a request, the error has reason PRINTER_REFUSED and contains the printer's
/// own keyword.
class Printer {
 public:
  /// @param gives_up  called repeatedly, from any thread. Once it returns true, every call ends
  ///                  soon with kCancelled, reason CANCELLED (within Timing::connect while there
  ///                  is no connection yet)
  explicit Printer(Address address, const Timing& timing = {}, std::function<bool()> gives_up = {});

  [[nodiscard]] Result<Attributes> attributes() const;

  /// Sends a document as a new job, on the given paper and unscaled. Never sends it twice: if the
  /// response is lost, the printer may have accepted the job, and the message says so. Also returns
  /// kInvalidArgument, reason FORMAT_NOT_SUPPORTED, and kFailedPrecondition, reason
  /// PRINTER_REFUSED.
  [[nodiscard]] Result<Submitted> print(const PrintJob& job) const;

  /// Returns the state of a job; kNotFound if the printer does not know it (any longer).
  [[nodiscard]] Result<JobReport> job(int id) const;

  /// Cancels a job; kFailedPrecondition if it has already ended.
  [[nodiscard]] Status cancel(int id) const;

  /// Waits until a job is finished and reports every change.
  /// @param is_cancelled  called at every poll. If it returns true, the job is cancelled, and
  ///                      follow() waits for its end
  /// @return the report if the job completed. Otherwise kAborted, reason PRINT_ABORTED or
  ///         PRINT_CANCELED, with the printer's reasons; kUnavailable, reason PRINTER_LOST, if the
  ///         printer does not respond; kUnavailable, reason PRINT_UNFINISHED, after Timing::job.
  [[nodiscard]] Result<JobReport> follow(
      int id, const std::function<void(const JobReport&)>& on_change = {},
      const std::function<bool()>& is_cancelled = {}) const;

 private:
  /// Returns the printer's state reasons; empty if it cannot be reached.
  [[nodiscard]] std::vector<std::string> state_reasons() const;

  Address address_;
  Timing timing_;
  std::function<bool()> gives_up_;
};

}  // namespace hydroprint::printer
