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

/// How long a printer is waited for.
struct Timing {
  std::chrono::milliseconds connect{5000};
  std::chrono::milliseconds answer{15000};   ///< to one question
  std::chrono::milliseconds upload{300000};  ///< a document with its answer
  std::chrono::milliseconds poll{1000};      ///< between two questions after a job
  /// A printer that cannot be asked for so long while it prints counts as lost.
  std::chrono::milliseconds patience{20000};
  std::chrono::milliseconds job{3600000};  ///< from being sent to its end
};

/// A size of paper that a printer knows.
struct Paper {
  std::string name;  ///< PWG 5101.1: "iso_a4_210x297mm"
  Eigen::Vector2d size_mm = Eigen::Vector2d::Zero();
};

/// What a printer says of itself.
struct Attributes {
  std::string name, make_and_model;
  std::string state;                       ///< "idle", "processing", "stopped"
  std::vector<std::string> state_reasons;  ///< "media-empty" and so on; empty: none
  bool accepts_jobs = false;
  std::vector<std::string> formats;  ///< MIME types
  std::vector<Paper> papers;
  /// The least that it leaves free at the left, right, top and bottom of the paper, mm; 0: it
  /// prints to the edge.
  Eigen::Vector4d margins_mm = Eigen::Vector4d::Zero();
};

/// What is to be printed.
struct PrintJob {
  std::span<const unsigned char> document;
  std::string format = "application/pdf";
  std::string name = "Hydroprint";
  Eigen::Vector2d paper_mm = {210, 297};  ///< as it lies in the tray
};

/// RFC 8011, section 5.3.7.
enum class JobState { kPending, kHeld, kProcessing, kStopped, kCanceled, kAborted, kCompleted };

[[nodiscard]] const char* job_state_name(JobState state);
[[nodiscard]] bool is_over(JobState state);

struct JobReport {
  int id = 0;
  JobState state = JobState::kPending;
  std::vector<std::string> reasons;  ///< "aborted-by-system" and so on
  /// Of follow() alone: what the printer says of itself, "media-empty" and so on.
  std::vector<std::string> printer_reasons;
  int pages_done = 0;  ///< sides printed, as far as the printer counts them
  bool operator==(const JobReport&) const = default;
};

/// What became of sending.
struct Submitted {
  int id = 0;
  /// Attributes that the printer said it would not heed; "print-scaling" among them means that it
  /// may not print at exact scale.
  std::vector<std::string> ignored;
};

/// A printer that speaks IPP (RFC 8010, RFC 8011), every call over a connection of its own. Holds
/// nothing but what it was made of; any thread. All calls end in bounded time (Timing) and refuse
/// with kUnavailable, reason PRINTER_UNREACHABLE, PRINTER_SILENT, PRINTER_LOST or PRINTER_NOT_IPP;
/// what a printer refuses itself is named with its own word for it, reason PRINTER_REFUSED.
class Printer {
 public:
  /// @param gives_up  asked again and again, from any thread: true ends every call soon, refused
  ///                  with kCancelled, reason PRINTER_LEFT (within Timing::connect while there is
  ///                  no connection yet)
  explicit Printer(Address address, const Timing& timing = {}, std::function<bool()> gives_up = {});

  [[nodiscard]] Result<Attributes> attributes() const;

  /// Sends a document as a job of its own, on that paper and not scaled. Never sent twice: where
  /// the answer is lost, the printer may have taken it or not, and the message says so. Refuses,
  /// too, with kInvalidArgument, reason FORMAT_NOT_SUPPORTED, and kFailedPrecondition, reason
  /// PRINTER_REFUSED.
  [[nodiscard]] Result<Submitted> print(const PrintJob& job) const;

  /// How a job is. kNotFound if the printer does not know it (any more).
  [[nodiscard]] Result<JobReport> job(int id) const;

  /// Asks for a job's end. kFailedPrecondition if it has one already.
  [[nodiscard]] Status cancel(int id) const;

  /// Follows a job to its end and reports every change.
  /// @param is_cancelled  asked at every poll; true has the job cancelled and followed on
  /// @return how it ended: kCompleted. Refuses with kAborted, reason PRINT_ABORTED or
  ///         PRINT_CANCELED, with the printer's reasons; kUnavailable, reason PRINTER_LOST, if it
  ///         cannot be asked any more; kUnavailable, reason PRINT_UNFINISHED, at Timing::job's end.
  [[nodiscard]] Result<JobReport> follow(
      int id, const std::function<void(const JobReport&)>& on_change = {},
      const std::function<bool()>& is_cancelled = {}) const;

 private:
  /// What it says of itself; nothing where it cannot be asked.
  [[nodiscard]] std::vector<std::string> state_reasons() const;

  Address address_;
  Timing timing_;
  std::function<bool()> gives_up_;
};

}  // namespace hydroprint::printer
