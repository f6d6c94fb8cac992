// Printing a simulation: print-image, template and print jobs, with a real IPP printer.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "tests/daemon/api/support.h"
#include "tests/hardware/printer/ipp_printer.h"

namespace hydroprint::tests {
namespace {

using nlohmann::json;
using printer::IppPrinter;

constexpr double kPatience_s = 120;

class PrintApi : public ::testing::Test {
 protected:
  void start(const std::string& printer_keys = "") {
    auto options = DaemonProcess::fake();
    if (!printer_keys.empty()) options.extra = "[printer]\n" + printer_keys;
    daemon_ = std::make_unique<DaemonProcess>(folder_.path(), options);
    client_ = std::make_unique<Client>(daemon_->address());
  }
  void start(const IppPrinter& there, int patience_s = 300) {
    start("address = \"" + there.address().uri + "\"\npatience_s = " + std::to_string(patience_s) +
          "\n");
  }

  v1::Job create(v1::Job wanted) {
    v1::CreateJobRequest request;
    *request.mutable_job() = std::move(wanted);
    v1::Job job;
    const grpc::Status status = client_->create(request, job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job;
  }
  /// Reason of the error with which a job is refused; "" if it is accepted.
  std::string refusal(v1::Job wanted) {
    v1::CreateJobRequest request;
    *request.mutable_job() = std::move(wanted);
    v1::Job job;
    return error_info(client_->create(request, job)).reason();
  }
  v1::Job done(const v1::Job& job) { return client_->wait_for_end(job.name()); }

  /// Runs a simulation and returns it when it has ended.
  v1::Job simulated(const std::string& film = "") {
    auto wanted = simulate_request(client_->upload("body"), "body.obj").job();
    wanted.mutable_simulate()->set_dpi(200);
    wanted.mutable_simulate()->set_scale(3);
    if (!film.empty()) {
      wanted.mutable_simulate()->set_film("polygon:film.json");
      auto& file = *wanted.mutable_simulate()->add_extra_files();
      file.set_name("film.json");
      file.set_asset(client_->upload(film));
    }
    return done(create(wanted));
  }
  static v1::Job print_image_of(const v1::Job& simulation) {
    v1::Job out;
    out.mutable_print_image()->set_simulate_job(simulation.name());
    return out;
  }
  static v1::Job print_of(const v1::Job& pages) {
    v1::Job out;
    out.mutable_print()->set_print_image_job(pages.name());
    return out;
  }
  /// Runs a print-image job and returns it; it has pages to print.
  v1::Job pages() { return done(create(print_image_of(simulated()))); }

  std::string file(const v1::Job& job, const std::string& name) {
    return client_->download(job.name() + "/artifacts/" + name);
  }
  /// All event messages of a job.
  std::string told(const v1::Job& job) {
    std::string out;
    for (const auto& event : client_->events(job.name())) out += event.message() + "\n";
    return out;
  }
  /// Waits until a print reaches that phase.
  v1::Job at(const v1::Job& job, const std::string& phase) {
    return client_->wait(job.name(), [&](const v1::Job& now) { return now.phase() == phase; });
  }

  TemporaryFolder folder_;
  std::unique_ptr<DaemonProcess> daemon_;
  std::unique_ptr<Client> client_;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(PrintApi, PrintImageUsesFilmAndResolutionOfItsSimulation) {
  start();
  const v1::Job simulation = simulated("[[0,0],[9,0],[0,9]]");
  const v1::Job job = done(create(print_image_of(simulation)));
  ASSERT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
  EXPECT_EQ(job.display_name(), "print-image " + simulation.name());
  EXPECT_EQ(job.print_image().simulate_job(), simulation.name());
  EXPECT_FALSE(job.print_image().has_film_image()) << "the job shows the spec as sent";
  const json spec = given_spec(file(job, "spec.json"));
  EXPECT_EQ(spec["filmImage"]["name"], "image/film.png");
  EXPECT_EQ(spec["film"], "polygon:film.json");
  EXPECT_EQ(spec["dpi"], 200);
  EXPECT_EQ(file(job, "print.pdf"), "%PDF of " + file(simulation, "film.png"));
}

TEST_F(PrintApi, ReprintIsIdenticalAfterTheSimulationIsDeleted) {
  start();
  const v1::Job simulation = simulated();
  const v1::Job first = done(create(print_image_of(simulation)));
  const v1::Job again = done(create(print_image_of(simulation)));
  EXPECT_TRUE(again.cache_hit());
  v1::DeleteJobRequest deletion;
  deletion.set_name(simulation.name());
  google::protobuf::Empty nothing;
  ASSERT_TRUE(client_->jobs->DeleteJob(client_->context().get(), deletion, &nothing).ok());
  v1::RetryJobRequest retry;
  retry.set_name(first.name());
  v1::Job retried;
  ASSERT_TRUE(client_->jobs->RetryJob(client_->context().get(), retry, &retried).ok());
  retried = done(retried);
  ASSERT_EQ(retried.state(), v1::Job::SUCCEEDED) << retried.error().message();
  EXPECT_EQ(retried.input_digest(), first.input_digest());
  EXPECT_EQ(file(retried, "print.pdf"), file(first, "print.pdf"));
}

TEST_F(PrintApi, TemplateUsesTheObjectOfItsSimulation) {
  start();
  const v1::Job simulation = simulated("[[0,0],[9,0],[0,9]]");
  v1::Job wanted;
  wanted.mutable_template_()->set_simulate_job(simulation.name());
  const v1::Job job = done(create(wanted));
  ASSERT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
  EXPECT_FALSE(job.template_().has_mesh());
  const std::string report = file(job, "report.json");
  EXPECT_TRUE(has(report, "template "));
  const json spec = given_spec(report);
  EXPECT_EQ(spec["mesh"]["name"], "body.obj");
  EXPECT_EQ(spec["scale"], 3);
  EXPECT_EQ(spec["film"], "polygon:film.json");
}

TEST_F(PrintApi, FieldsTakenFromASimulationMustNotBeSet) {
  start();
  const v1::Job simulation = simulated();
  v1::Job twice = print_image_of(simulation);
  twice.mutable_print_image()->set_film("A4");
  EXPECT_EQ(refusal(twice), "SPEC_INVALID");
  twice = print_image_of(simulation);
  twice.mutable_print_image()->set_dpi(300);
  EXPECT_EQ(refusal(twice), "SPEC_INVALID");
  twice = print_image_of(simulation);
  twice.mutable_print_image()->mutable_film_image()->set_name("film.png");
  EXPECT_EQ(refusal(twice), "SPEC_INVALID");
  v1::Job placed;
  placed.mutable_template_()->set_simulate_job(simulation.name());
  placed.mutable_template_()->set_scale(1);
  EXPECT_EQ(refusal(placed), "SPEC_INVALID");
}

TEST_F(PrintApi, SimulationMustHaveSucceeded) {
  start();
  v1::Job nobody;
  nobody.set_name("jobs/99");
  EXPECT_EQ(refusal(print_image_of(nobody)), "JOB_NOT_FOUND");
  nobody.set_name("7");
  EXPECT_EQ(refusal(print_image_of(nobody)), "ID_INVALID");
  const v1::Job failed = done(client_->simulate("exit 4 broken"));
  EXPECT_EQ(refusal(print_image_of(failed)), "STATE_FORBIDS");
  EXPECT_EQ(refusal(print_image_of(pages())), "SPEC_INVALID")
      << "a print-image job is not a simulation";
  EXPECT_EQ(refusal(print_of(failed)), "SPEC_INVALID") << "a simulation has no pages to print";
}

TEST_F(PrintApi, PagesAreSentOnceAndFollowedToTheEnd) {
  const IppPrinter there(IppPrinter::kUntilFinished);
  start(there);
  const v1::Job printed = pages();
  const v1::Job job = create(print_of(printed));
  EXPECT_EQ(job.state(), v1::Job::RUNNING);
  EXPECT_EQ(job.display_name(), "print " + printed.name());
  at(job, "PROCESSING");
  EXPECT_EQ(refusal(print_of(printed)), "STATE_FORBIDS") << "prints run one at a time";
  there.finish();
  const v1::Job ended = done(job);
  EXPECT_EQ(ended.state(), v1::Job::SUCCEEDED) << ended.error().message();
  EXPECT_EQ(ended.progress_fraction(), 1);
  EXPECT_EQ(content(there.spooled()), file(printed, "print.pdf"));
  const std::string words = told(job);
  EXPECT_TRUE(has(words, "sending " + printed.name() + " to Test printer")) << words;
  EXPECT_TRUE(has(words, "processing: job-printing")) << words;
  EXPECT_TRUE(has(words, "completed")) << words;
  const json report = json::parse(file(ended, "report.json"));
  EXPECT_EQ(report["outcome"], "SUCCEEDED");
  EXPECT_EQ(report["paper_mm"], (json{210, 297})) << "the paper lies upright in the tray";
  EXPECT_EQ(report["states"].back()["state"], "completed");
  EXPECT_EQ(report["printer_address"], there.address().uri);
  v1::RetryJobRequest retry;
  retry.set_name(job.name());
  v1::Job retried;
  const auto status = client_->jobs->RetryJob(client_->context().get(), retry, &retried);
  EXPECT_EQ(error_info(status).reason(), "STATE_FORBIDS") << "prints are not retried";
}

TEST_F(PrintApi, PrinterOutOfPaperIsReported) {
  const IppPrinter there(std::string("echo 'STATE: +media-empty' >&2\n") +
                         IppPrinter::kUntilFinished);
  start(there);
  const v1::Job job = create(print_of(pages()));
  const auto is_reported = [&] { return has(told(job), "media-empty"); };
  const auto is_finished = [&] { return finished(client_->job(job.name())); };
  EXPECT_TRUE(wait_until([&] { return is_reported() || is_finished(); }, kPatience_s));
  EXPECT_TRUE(is_reported()) << told(job);
  there.finish();
  EXPECT_EQ(done(job).state(), v1::Job::SUCCEEDED);
}

TEST_F(PrintApi, CancelEndsThePrintOnThePrinter) {
  const IppPrinter there(IppPrinter::kUntilFinished);
  start(there);
  const v1::Job job = at(create(print_of(pages())), "PROCESSING");
  EXPECT_EQ(client_->cancel(job.name()).state(), v1::Job::CANCELLING);
  // This printer completes the page that it is printing before it cancels the job.
  const printer::Printer asked(there.address());
  const auto is_stopping = [&] {
    return asked.job(1).value().reasons == std::vector<std::string>{"processing-to-stop-point"};
  };
  EXPECT_TRUE(wait_until(is_stopping, kPatience_s)) << "the printer was not told to cancel the job";
  there.finish();
  const v1::Job ended = done(job);
  EXPECT_EQ(ended.state(), v1::Job::CANCELLED);
  EXPECT_EQ(json::parse(file(ended, "report.json"))["states"].back()["state"], "canceled");
}

TEST_F(PrintApi, AbortedPrintFailsWithThePrintersMessage) {
  const IppPrinter there("exit 1");
  start(there);
  const v1::Job ended = done(create(print_of(pages())));
  EXPECT_EQ(ended.state(), v1::Job::FAILED);
  EXPECT_EQ(ended.error().reason(), v1::PRINT_ABORTED);
  EXPECT_TRUE(has(ended.error().message(), "aborted")) << ended.error().message();
  EXPECT_EQ(json::parse(file(ended, "report.json"))["reason"], "PRINT_ABORTED");
}

TEST_F(PrintApi, MissingOrUnreachablePrinterIsReported) {
  start();
  EXPECT_EQ(refusal(print_of(pages())), "PRINTER_MISSING");
  daemon_.reset();
  start("address = \"ipp://127.0.0.1:1/ipp/print\"\n");
  const v1::Job ended = done(create(print_of(pages())));
  EXPECT_EQ(ended.state(), v1::Job::FAILED);
  EXPECT_EQ(ended.error().reason(), v1::PRINTER_UNREACHABLE) << ended.error().message();
}

TEST_F(PrintApi, PrinterLostDuringAPrintFailsTheJob) {
  IppPrinter there(IppPrinter::kUntilFinished);
  start(there, 5);
  const v1::Job job = at(create(print_of(pages())), "PROCESSING");
  there.pull_the_plug();
  const v1::Job ended = done(job);
  EXPECT_EQ(ended.state(), v1::Job::FAILED);
  EXPECT_EQ(ended.error().reason(), v1::PRINTER_LOST);
  EXPECT_TRUE(has(ended.error().message(), "may or may not have been printed"));
}

TEST_F(PrintApi, KillInterruptsThePrintAndNothingIsSentAgain) {
  const IppPrinter there(IppPrinter::kUntilFinished);
  start(there);
  const v1::Job job = at(create(print_of(pages())), "PROCESSING");
  daemon_->kill();
  daemon_->start();
  client_ = std::make_unique<Client>(daemon_->address());
  EXPECT_EQ(client_->job(job.name()).state(), v1::Job::INTERRUPTED);
  EXPECT_TRUE(has(told(job), "may already have printed this"));
  there.finish();
  EXPECT_TRUE(std::filesystem::exists(there.spooled())) << "the document was sent once";
}

TEST_F(PrintApi, ShutdownLeavesThePrintToThePrinter) {
  const IppPrinter there(IppPrinter::kUntilFinished);
  start(there);
  const v1::Job job = at(create(print_of(pages())), "PROCESSING");
  EXPECT_EQ(daemon_->terminate(), 0);
  const printer::Printer asked(there.address());
  EXPECT_EQ(asked.job(1).value().state, printer::JobState::kProcessing);
  daemon_->start();
  client_ = std::make_unique<Client>(daemon_->address());
  EXPECT_EQ(client_->job(job.name()).state(), v1::Job::INTERRUPTED);
}

}  // namespace
}  // namespace hydroprint::tests
