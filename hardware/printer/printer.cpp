#include "hardware/printer/printer.h"

#include <cups/cups.h>
#include <cups/pwg.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

#include "hardware/printer/exchange.h"

namespace hydroprint::printer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kUser = "hydroprint";
constexpr double kUnitsPerMm = 100;  // units of PWG media sizes

Ipp request_of(ipp_op_t operation, const Address& address) {
  Ipp out(ippNewRequest(operation));  // includes charset and language
  ippAddString(out.get(), IPP_TAG_OPERATION, IPP_TAG_URI, "printer-uri", nullptr,
               address.uri.c_str());
  return out;
}

void add_user(ipp_t* request) {
  ippAddString(request, IPP_TAG_OPERATION, IPP_TAG_NAME, "requesting-user-name", nullptr, kUser);
}

void add_job(ipp_t* request, int id) {
  ippAddInteger(request, IPP_TAG_OPERATION, IPP_TAG_INTEGER, "job-id", id);
  add_user(request);
}

template <std::size_t kCount>
void ask_for(ipp_t* request, const std::array<const char*, kCount>& names) {
  ippAddStrings(request, IPP_TAG_OPERATION, IPP_TAG_KEYWORD, "requested-attributes",
                static_cast<int>(kCount), nullptr, names.data());
}

std::vector<std::string> texts(ipp_t* reply, const char* name) {
  std::vector<std::string> out;
  ipp_attribute_t* attribute = ippFindAttribute(reply, name, IPP_TAG_ZERO);
  for (int i = 0; attribute != nullptr && i < ippGetCount(attribute); ++i) {
    const char* text = ippGetString(attribute, i, nullptr);
    if (text != nullptr) out.emplace_back(text);
  }
  return out;
}

std::string text(ipp_t* reply, const char* name) {
  const auto all = texts(reply, name);
  return all.empty() ? std::string() : all.front();
}

std::optional<int> number(ipp_t* reply, const char* name, ipp_tag_t type) {
  ipp_attribute_t* attribute = ippFindAttribute(reply, name, type);
  if (attribute == nullptr) return std::nullopt;
  return ippGetInteger(attribute, 0);
}

/// Returns the listed reasons, without the keyword "none".
std::vector<std::string> reasons(ipp_t* reply, const char* name) {
  std::vector<std::string> out = texts(reply, name);
  std::erase(out, "none");
  return out;
}

/// Returns the smallest supported value, in mm. Printers that can print to the edge list 0 among
/// others.
double least_mm(ipp_t* reply, const char* name) {
  ipp_attribute_t* attribute = ippFindAttribute(reply, name, IPP_TAG_INTEGER);
  int least = 0;
  for (int i = 0; attribute != nullptr && i < ippGetCount(attribute); ++i) {
    const int value = ippGetInteger(attribute, i);
    least = i == 0 ? value : std::min(least, value);
  }
  return least / kUnitsPerMm;
}

std::vector<Paper> papers(ipp_t* reply) {
  std::vector<Paper> out;
  for (const std::string& name : texts(reply, "media-supported")) {
    const pwg_media_t* media = pwgMediaForPWG(name.c_str());
    if (media == nullptr) continue;
    out.push_back({name, {media->width / kUnitsPerMm, media->length / kUnitsPerMm}});
  }
  return out;
}

/// Returns the attributes of the request that the reply reports as ignored.
std::vector<std::string> ignored(ipp_t* reply) {
  std::vector<std::string> out;
  for (ipp_attribute_t* a = ippFirstAttribute(reply); a != nullptr; a = ippNextAttribute(reply)) {
    const char* name = ippGetName(a);
    if (ippGetGroupTag(a) == IPP_TAG_UNSUPPORTED_GROUP && name != nullptr) out.emplace_back(name);
  }
  return out;
}

bool is_ok(ipp_t* reply) { return ippGetStatusCode(reply) < IPP_STATUS_REDIRECTION_OTHER_SITE; }

/// Returns whether the printer rejects the document format. Printers report this with a specific
/// status, or by naming the attribute.
bool is_about_format(ipp_t* reply) {
  if (ippGetStatusCode(reply) == IPP_STATUS_ERROR_DOCUMENT_FORMAT_NOT_SUPPORTED) return true;
  const auto names = ignored(reply);
  return std::find(names.begin(), names.end(), "document-format") != names.end();
}

tl::unexpected<Error> incomplete(const Address& address, const std::string& what) {
  return fail(
      Code::kFailedPrecondition,
      fmt::format("printer {}: its reply lacks {}. Check the printer's display", address.uri, what),
      ErrorReason::PRINTER_REFUSED);
}

tl::unexpected<Error> refused(const Address& address, const std::string& what, ipp_t* reply) {
  const ipp_status_t status = ippGetStatusCode(reply);
  const std::string message = text(reply, "status-message");
  const std::string start =
      fmt::format("printer {}: refuses {} ({}{}{}). ", address.uri, what, ippErrorString(status),
                  message.empty() ? "" : ": ", message);
  if (is_about_format(reply)) {
    return fail(Code::kInvalidArgument, start + "Use a format that the printer supports",
                ErrorReason::FORMAT_NOT_SUPPORTED);
  }
  if (status == IPP_STATUS_ERROR_NOT_FOUND) {
    return fail(Code::kNotFound, start + "Check the address and the job number",
                ErrorReason::PRINTER_REFUSED);
  }
  return fail(Code::kFailedPrecondition, start + "Check its display", ErrorReason::PRINTER_REFUSED);
}

JobState job_state(int ipp_state) {
  switch (ipp_state) {
    case IPP_JSTATE_HELD:
      return JobState::kHeld;
    case IPP_JSTATE_PROCESSING:
      return JobState::kProcessing;
    case IPP_JSTATE_STOPPED:
      return JobState::kStopped;
    case IPP_JSTATE_CANCELED:
      return JobState::kCanceled;
    case IPP_JSTATE_ABORTED:
      return JobState::kAborted;
    case IPP_JSTATE_COMPLETED:
      return JobState::kCompleted;
    default:
      return JobState::kPending;
  }
}

std::string state_name(std::optional<int> state) {
  if (!state) return "unknown";
  return ippEnumString("printer-state", *state);
}

ExchangeTiming question(const Timing& timing) {
  return {timing.connect, timing.answer, 2 * timing.answer};
}

/// Converts the final report of a job to the result of follow().
Result<JobReport> outcome(const Address& address, const JobReport& report) {
  if (report.state == JobState::kCompleted) return report;
  const bool canceled = report.state == JobState::kCanceled;
  const std::string why =
      report.reasons.empty() ? "" : fmt::format(" ({})", fmt::join(report.reasons, ", "));
  return fail(
      Code::kAborted,
      fmt::format("printer {}: job {} was {}{}. Check the printer's display, then print again",
                  address.uri, report.id, canceled ? "cancelled" : "aborted", why),
      canceled ? ErrorReason::PRINT_CANCELED : ErrorReason::PRINT_ABORTED);
}

}  // namespace

const char* job_state_name(JobState state) {
  switch (state) {
    case JobState::kPending:
      return "pending";
    case JobState::kHeld:
      return "held";
    case JobState::kProcessing:
      return "processing";
    case JobState::kStopped:
      return "stopped";
    case JobState::kCanceled:
      return "canceled";
    case JobState::kAborted:
      return "aborted";
    case JobState::kCompleted:
      return "completed";
  }
  return "";
}

bool is_over(JobState state) {
  return state == JobState::kCanceled || state == JobState::kAborted ||
         state == JobState::kCompleted;
}

Printer::Printer(Address address, const Timing& timing, std::function<bool()> gives_up)
    : address_(std::move(address)), timing_(timing), gives_up_(std::move(gives_up)) {}

Result<Attributes> Printer::attributes() const {
  const Ipp request = request_of(IPP_OP_GET_PRINTER_ATTRIBUTES, address_);
  add_user(request.get());
  ask_for(request.get(), std::array{"printer-name", "printer-make-and-model", "printer-state",
                                    "printer-state-reasons", "printer-is-accepting-jobs",
                                    "document-format-supported", "media-supported",
                                    "media-left-margin-supported", "media-right-margin-supported",
                                    "media-top-margin-supported", "media-bottom-margin-supported"});
  HP_ASSIGN_OR_RETURN(const Ipp reply,
                      exchange(address_, question(timing_), gives_up_, request.get()));
  if (!is_ok(reply.get())) return refused(address_, "to report its attributes", reply.get());
  Attributes out;
  out.name = text(reply.get(), "printer-name");
  out.make_and_model = text(reply.get(), "printer-make-and-model");
  out.state = state_name(number(reply.get(), "printer-state", IPP_TAG_ENUM));
  out.state_reasons = reasons(reply.get(), "printer-state-reasons");
  ipp_attribute_t* accepts =
      ippFindAttribute(reply.get(), "printer-is-accepting-jobs", IPP_TAG_BOOLEAN);
  out.accepts_jobs = accepts != nullptr && ippGetBoolean(accepts, 0) != 0;
  out.formats = texts(reply.get(), "document-format-supported");
  out.papers = papers(reply.get());
  out.margins_mm = {least_mm(reply.get(), "media-left-margin-supported"),
                    least_mm(reply.get(), "media-right-margin-supported"),
                    least_mm(reply.get(), "media-top-margin-supported"),
                    least_mm(reply.get(), "media-bottom-margin-supported")};
  return out;
}

Result<Submitted> Printer::print(const PrintJob& job) const {
  const Ipp request = request_of(IPP_OP_PRINT_JOB, address_);
  add_user(request.get());
  ippAddString(request.get(), IPP_TAG_OPERATION, IPP_TAG_NAME, "job-name", nullptr,
               job.name.c_str());
  ippAddString(request.get(), IPP_TAG_OPERATION, IPP_TAG_MIMETYPE, "document-format", nullptr,
               job.format.c_str());
  const auto units = [](double mm) { return static_cast<int>(std::lround(mm * kUnitsPerMm)); };
  const pwg_media_t* media = pwgMediaForSize(units(job.paper_mm.x()), units(job.paper_mm.y()));
  if (media == nullptr)
    return fail(Code::kOutOfRange, "paper: not a standard size. Use a standard size, such as A4");
  ippAddString(request.get(), IPP_TAG_JOB, IPP_TAG_KEYWORD, "media", nullptr, media->pwg);
  ippAddString(request.get(), IPP_TAG_JOB, IPP_TAG_KEYWORD, "print-scaling", nullptr, "none");
  auto reply = exchange(address_, {timing_.connect, timing_.answer, timing_.upload}, gives_up_,
                        request.get(), job.document);
  if (!reply) {
    Error error = std::move(reply).error();
    if (error.reason != ErrorReason::PRINTER_UNREACHABLE) {
      error.message +=
          ". The printer may have accepted the job. Check the printer before you print again";
    }
    return tl::unexpected(std::move(error));
  }
  if (!is_ok(reply->get())) return refused(address_, job.format, reply->get());
  const auto id = number(reply->get(), "job-id", IPP_TAG_INTEGER);
  if (!id) return incomplete(address_, "the job's number");
  return Submitted{*id, ignored(reply->get())};
}

Result<JobReport> Printer::job(int id) const {
  const Ipp request = request_of(IPP_OP_GET_JOB_ATTRIBUTES, address_);
  add_job(request.get(), id);
  ask_for(request.get(), std::array{"job-state", "job-state-reasons", "job-impressions-completed"});
  HP_ASSIGN_OR_RETURN(const Ipp reply,
                      exchange(address_, question(timing_), gives_up_, request.get()));
  if (!is_ok(reply.get())) {
    return refused(address_, fmt::format("to report job {}", id), reply.get());
  }
  const auto state = number(reply.get(), "job-state", IPP_TAG_ENUM);
  if (!state) return incomplete(address_, fmt::format("the state of job {}", id));
  return JobReport{id,
                   job_state(*state),
                   reasons(reply.get(), "job-state-reasons"),
                   {},
                   number(reply.get(), "job-impressions-completed", IPP_TAG_INTEGER).value_or(0)};
}

std::vector<std::string> Printer::state_reasons() const {
  const Ipp request = request_of(IPP_OP_GET_PRINTER_ATTRIBUTES, address_);
  add_user(request.get());
  ask_for(request.get(), std::array{"printer-state-reasons"});
  const auto reply = exchange(address_, question(timing_), gives_up_, request.get());
  if (!reply || !is_ok(reply->get())) return {};
  return reasons(reply->get(), "printer-state-reasons");
}

Status Printer::cancel(int id) const {
  const Ipp request = request_of(IPP_OP_CANCEL_JOB, address_);
  add_job(request.get(), id);
  HP_ASSIGN_OR_RETURN(const Ipp reply,
                      exchange(address_, question(timing_), gives_up_, request.get()));
  if (!is_ok(reply.get())) {
    return refused(address_, fmt::format("to cancel job {}", id), reply.get());
  }
  return {};
}

Result<JobReport> Printer::follow(int id, const std::function<void(const JobReport&)>& on_change,
                                  const std::function<bool()>& is_cancelled) const {
  const Clock::time_point end = Clock::now() + timing_.job;
  Clock::time_point last_report = Clock::now();
  JobReport last;  // no job has the number 0
  bool asked_to_cancel = false;
  while (true) {
    auto report = job(id);
    if (!report && report.error().code != Code::kUnavailable) return report;
    if (!report && Clock::now() - last_report >= timing_.patience) {
      report.error().message += fmt::format(". Job {} may or may not have been printed", id);
      report.error().reason = ErrorReason::PRINTER_LOST;
      return report;
    }
    if (report) {
      last_report = Clock::now();
      if (!is_over(report->state)) report->printer_reasons = state_reasons();
      const bool is_news = last.id == 0 || *report != last;
      if (is_news && on_change) on_change(*report);
      last = *report;
      if (is_over(last.state)) return outcome(address_, last);
    }
    if (!asked_to_cancel && is_cancelled && is_cancelled()) {
      asked_to_cancel = cancel(id).has_value();
    }
    if (Clock::now() >= end) {
      return fail(Code::kUnavailable,
                  fmt::format("printer {}: job {} is still {}. Check the printer's display",
                              address_.uri, id, job_state_name(last.state)),
                  ErrorReason::PRINT_UNFINISHED);
    }
    std::this_thread::sleep_for(timing_.poll);
  }
}

}  // namespace hydroprint::printer
