#include "daemon/printing/session.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <thread>

#include "daemon/jobs/report.h"
#include "daemon/platform/durable_file.h"
#include "daemon/platform/log.h"
#include "daemon/platform/resource_names.h"
#include "daemon/store/artifact_files.h"
#include "daemon/store/to_proto.h"
#include "proto/write_json.h"
#include "sim/base/input_file.h"
#include "sim/base/sha256.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kLargestPdf = std::size_t{2} << 30;
constexpr std::chrono::milliseconds kStoreAgainAfter{500};
// Progress at which sending starts and ends; fixed, because the duration of a print is unknown.
constexpr double kSending = 0.05, kSent = 0.3;

std::string phase_of(printer::JobState state) {
  std::string out = printer::job_state_name(state);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return out;
}

}  // namespace

PrintSession::PrintSession(const PrinterConfig& setup, DeviceJobs& jobs, const Layout& layout,
                           const Job& job, const PrintPlan& plan)
    : setup_(setup), jobs_(jobs), layout_(layout), job_(job.id) {
  facts_.job = job_name(job.id);
  facts_.create_time = time_text(job.create_ms);
  facts_.plan = plan;
  facts_.address = setup.address.uri;
}

void PrintSession::go() {
  const Status done = print();
  if (!done && left_ && done.error().code == Code::kCancelled)
    return;  // the store sets INTERRUPTED
  finish(done);
}

Status PrintSession::print() {
  publish("ASKING", 0, "connecting to " + facts_.address);
  const printer::Printer device(setup_.address, setup_.timing,
                                [this] { return cancelled_ || left_; });
  HP_ASSIGN_OR_RETURN(facts_.printer, device.attributes());
  HP_RETURN_IF_ERROR(check_takes_pdf(facts_.printer, facts_.address));
  note(warnings_of(facts_.plan, facts_.printer));
  HP_ASSIGN_OR_RETURN(const printer::Submitted sent, send());
  note(warnings_of(sent.ignored));
  // A document that was sent is followed to its end, even after a cancellation.
  const printer::Printer followed(setup_.address, setup_.timing, [this] { return left_.load(); });
  HP_RETURN_IF_ERROR(followed.follow(
      sent.id, [this](const printer::JobReport& report) { note(report); },
      [this] { return cancelled_.load(); }));
  return {};
}

Result<printer::Submitted> PrintSession::send() {
  publish("SENDING", kSending,
          fmt::format("sending {} to {}", facts_.plan.print_image_job, facts_.printer.name));
  HP_ASSIGN_OR_RETURN(const std::string pdf, read_text_file(facts_.plan.pdf, kLargestPdf));
  if (sha256(pdf) != facts_.plan.sha256) {
    return fail(Code::kDataLoss,
                facts_.plan.print_image_job + ": its print.pdf is damaged; retry that job",
                ErrorReason::ARTIFACT_DAMAGED);
  }
  printer::PrintJob what;
  what.document = {reinterpret_cast<const unsigned char*>(pdf.data()), pdf.size()};
  what.name = "Hydroprint " + facts_.job;
  what.paper_mm = facts_.plan.paper_mm;
  const printer::Printer sender(setup_.address, setup_.timing,
                                [this] { return cancelled_ || left_; });
  return sender.print(what);
}

void PrintSession::note(const Warnings& warnings) {
  for (const Warning& warning : warnings) {
    facts_.warnings.push_back(warning);
    publish("SENDING", kSending, "warning: " + warning.message);
  }
}

void PrintSession::note(const printer::JobReport& report) {
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begun_;
  facts_.news.push_back({passed.count(), report});
  const double pages = std::min(1.0, static_cast<double>(report.pages_done) / facts_.plan.pages);
  publish(phase_of(report.state), kSent + (1 - kSent) * pages,
          fmt::format("printer's job {}: {}", report.id, words_of(report)));
}

void PrintSession::publish(std::string_view phase, double fraction, const std::string& message) {
  const Status status =
      jobs_.advance(job_, JobState::kRunning, "", {fraction, std::string(phase), 0, 0}, message);
  if (!status) {
    log(LogLevel::kError, "progress_lost", {{"job", job_}, {"message", status.error().message}});
  }
  log(LogLevel::kInfo, "print_step", {{"job", job_}, {"step", phase}, {"message", message}});
}

/// A print that was cancelled too late counts as printed.
JobState PrintSession::ending(const Status& done) const {
  if (done) return JobState::kSucceeded;
  const Error& error = done.error();
  const bool is_cancel =
      error.code == Code::kCancelled || error.reason == ErrorReason::PRINT_CANCELED;
  return cancelled_ && is_cancel ? JobState::kCancelled : JobState::kFailed;
}

void PrintSession::finish(const Status& done) {
  const JobState state = ending(done);
  std::optional<JobFailure> failure;
  if (state == JobState::kFailed) failure = {done.error(), {}, {}};
  facts_.outcome = name_of(state);
  facts_.reason = failure ? failure->error.reason : ErrorReason{};
  facts_.message = done ? "printed" : done.error().message;
  const auto record = publish_record();
  for (;;) {
    const auto ended = jobs_.end(job_, state, failure, "", record, facts_.message);
    if (ended) break;
    log(LogLevel::kError, "job_end_lost", {{"job", job_}, {"message", ended.error().message}});
    if (left_) return;  // the next start sets INTERRUPTED
    std::this_thread::sleep_for(kStoreAgainAfter);
  }
  log(LogLevel::kInfo, "job_ended",
      {{"job", job_}, {"state", name_of(state)}, {"message", facts_.message}});
}

/// If the record cannot be stored, the print ends without it, because its outcome is more
/// important.
std::vector<Artifact> PrintSession::publish_record() {
  const auto folder = layout_.run(job_).out();
  const auto written = [&]() -> Result<std::vector<Artifact>> {
    HP_RETURN_IF_ERROR(make_folder(folder));
    HP_ASSIGN_OR_RETURN(const std::string text, json_file_of(report_of(facts_)));
    HP_ASSIGN_OR_RETURN(const UniqueFd file,
                        open_file(folder / kReport, O_WRONLY | O_CREAT | O_TRUNC));
    HP_RETURN_IF_ERROR(write_at(file, folder / kReport, text, 0));
    return publish_artifacts(folder, layout_.artifacts(job_));
  };
  auto record = written();
  discard(layout_.run(job_).root);
  if (record) return std::move(*record);
  log(LogLevel::kError, "record_lost", {{"job", job_}, {"message", record.error().message}});
  return {};
}

}  // namespace hydroprint::daemon
