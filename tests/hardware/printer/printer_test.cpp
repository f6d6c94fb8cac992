#include "hardware/printer/printer.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <random>
#include <thread>

#include "tests/hardware/printer/ipp_printer.h"
#include "tests/support/content.h"

namespace hydroprint::printer {
namespace {

using std::chrono::milliseconds;
using testing::content;

/// Short poll intervals, and a short wait for a printer that does not respond, but a long timeout
/// for slow replies.
Timing quick() {
  Timing timing;
  timing.connect = timing.answer = milliseconds(60000);
  timing.poll = milliseconds(50);
  timing.patience = milliseconds(500);
  return timing;
}

std::vector<unsigned char> some_bytes(std::size_t count) {
  std::mt19937 random(11);
  std::vector<unsigned char> out(count);
  for (unsigned char& byte : out) byte = static_cast<unsigned char>(random());
  return out;
}

/// A socket that accepts connections; the test decides what happens on them.
class Listener {
 public:
  Listener() : file_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    EXPECT_EQ(::bind(file_, reinterpret_cast<sockaddr*>(&at), sizeof at), 0);
    EXPECT_EQ(::getsockname(file_, reinterpret_cast<sockaddr*>(&at), &size), 0);
    EXPECT_EQ(::listen(file_, 8), 0);
    port_ = ntohs(at.sin_port);
  }
  ~Listener() { ::close(file_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  [[nodiscard]] Address address() const {
    return parse_address("ipp://127.0.0.1:" + std::to_string(port_) + "/ipp/print").value();
  }
  [[nodiscard]] int accept() const { return ::accept(file_, nullptr, nullptr); }

 private:
  int file_;
  int port_ = 0;
};

TEST(Printer, ReportsFormatsPaperAndMargins) {
  const IppPrinter there("exit 0");
  const auto attributes = Printer(there.address()).attributes();
  ASSERT_TRUE(attributes) << attributes.error().message;
  EXPECT_EQ(attributes->name, "Test printer");
  EXPECT_EQ(attributes->state, "idle");
  EXPECT_TRUE(attributes->accepts_jobs);
  const auto& formats = attributes->formats;
  EXPECT_NE(std::find(formats.begin(), formats.end(), "application/pdf"), formats.end());
  const auto a4 = std::find_if(attributes->papers.begin(), attributes->papers.end(),
                               [](const Paper& p) { return p.name == "iso_a4_210x297mm"; });
  ASSERT_NE(a4, attributes->papers.end());
  EXPECT_EQ(a4->size_mm, Eigen::Vector2d(210, 297));
  EXPECT_GE(attributes->margins_mm.minCoeff(), 0);
  EXPECT_LT(attributes->margins_mm.maxCoeff(), 20);
}

TEST(Printer, PrintsTheExactBytesUnscaledAndReportsCompletion) {
  // The print lasts until the test has seen the job.
  const IppPrinter there(std::string("env | grep ^IPP_ > \"$0.env\"\n") +
                         IppPrinter::kUntilFinished);
  const auto bytes = some_bytes(3'000'001);
  const Printer printer(there.address(), quick());
  const auto sent = printer.print({bytes, "application/pdf", "mug 7", {210, 297}});
  ASSERT_TRUE(sent) << sent.error().message;
  EXPECT_EQ(std::count(sent->ignored.begin(), sent->ignored.end(), "print-scaling"), 0);
  std::vector<JobState> seen;
  const auto ended = printer.follow(sent->id, [&](const JobReport& report) {
    seen.push_back(report.state);
    if (report.state == JobState::kProcessing) there.finish();
  });
  ASSERT_TRUE(ended) << ended.error().message;
  EXPECT_EQ(ended->state, JobState::kCompleted);
  EXPECT_EQ(seen.back(), JobState::kCompleted);
  EXPECT_GE(std::count(seen.begin(), seen.end(), JobState::kProcessing), 1);
  EXPECT_TRUE(content(there.spooled()) == std::string(bytes.begin(), bytes.end()));
  const std::string environment = content(there.folder() / "print.sh.env");
  EXPECT_NE(environment.find("IPP_MEDIA=iso_a4_210x297mm"), std::string::npos) << environment;
  EXPECT_NE(environment.find("IPP_PRINT_SCALING=none"), std::string::npos) << environment;
  EXPECT_NE(environment.find("IPP_JOB_NAME=mug 7"), std::string::npos) << environment;
}

TEST(Printer, ReportsAnAbortedJob) {
  const IppPrinter there("exit 1");
  const Printer printer(there.address(), quick());
  const auto sent = printer.print({some_bytes(1000)});
  ASSERT_TRUE(sent);
  const auto ended = printer.follow(sent->id);
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().reason, ErrorReason::PRINT_ABORTED);
  EXPECT_NE(ended.error().message.find("aborted"), std::string::npos);
}

TEST(Printer, CancelsAJobAndReportsItsEnd) {
  // The print lasts until the test has seen the job being cancelled.
  const IppPrinter there(IppPrinter::kUntilFinished);
  const Printer printer(there.address(), quick());
  const auto sent = printer.print({some_bytes(1000)});
  ASSERT_TRUE(sent);
  int polls = 0;
  const auto ended = printer.follow(
      sent->id,
      [&](const JobReport& report) {
        const auto& why = report.reasons;
        if (std::find(why.begin(), why.end(), "processing-to-stop-point") == why.end()) return;
        there.finish();
      },
      [&] { return ++polls > 2; });
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().reason, ErrorReason::PRINT_CANCELED) << ended.error().message;
  EXPECT_FALSE(printer.cancel(sent->id));
}

TEST(Printer, EndsEveryCallWhenTheCallerGivesUp) {
  const Listener silent;
  std::atomic<bool> gives_up = false;
  const Printer printer(silent.address(), quick(), [&] { return gives_up.load(); });
  std::thread asked(
      [&] { EXPECT_EQ(printer.attributes().error().reason, ErrorReason::CANCELLED); });
  (void)silent.accept();  // connected, but no data arrives
  gives_up = true;
  asked.join();
  EXPECT_EQ(printer.print({some_bytes(1000)}).error().reason, ErrorReason::CANCELLED);
  EXPECT_EQ(printer.follow(1).error().reason, ErrorReason::CANCELLED);
}

TEST(Printer, ReportsAnUnsupportedFormat) {
  const IppPrinter there("exit 0");
  const auto sent = Printer(there.address()).print({some_bytes(2'000'000), "image/tiff"});
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().code, Code::kInvalidArgument);
  EXPECT_EQ(sent.error().reason, ErrorReason::FORMAT_NOT_SUPPORTED) << sent.error().message;
}

TEST(Printer, ReportsAnUnknownJob) {
  const IppPrinter there("exit 0");
  EXPECT_EQ(Printer(there.address()).job(4711).error().code, Code::kNotFound);
}

TEST(Printer, DetectsAPrinterThatIsLostDuringAJob) {
  IppPrinter there(IppPrinter::kUntilFinished);
  const Printer printer(there.address(), quick());
  const auto sent = printer.print({some_bytes(1000)});
  ASSERT_TRUE(sent);
  const auto ended = printer.follow(sent->id, [&](const JobReport& report) {
    if (report.state == JobState::kProcessing) there.pull_the_plug();
  });
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().reason, ErrorReason::PRINTER_LOST);
  EXPECT_NE(ended.error().message.find("may or may not have been printed"), std::string::npos);
}

TEST(Printer, TimesOutWhenThePrinterNeverResponds) {
  const Listener silent;
  Timing timing = quick();
  timing.connect = milliseconds(5000);
  timing.answer = milliseconds(300);
  timing.upload = milliseconds(700);
  const Printer printer(silent.address(), timing);
  EXPECT_EQ(printer.attributes().error().reason, ErrorReason::PRINTER_SILENT);
  // The document is larger than the system's socket buffers, so sending it blocks.
  const std::vector<unsigned char> large(40'000'000);
  const auto sent = printer.print({large});
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().reason, ErrorReason::PRINTER_SILENT);
  EXPECT_NE(sent.error().message.find("The printer may have accepted the job"), std::string::npos);
}

TEST(Printer, TimesOutWhenThePrinterRespondsByteByByte) {
  const Listener listener;
  std::atomic<bool> stop = false;
  std::thread slow_client([&] {
    const int file = listener.accept();
    const std::string reply = "HTTP/1.1 200 OK\r\nContent-Type: application/ipp\r\n";
    for (std::size_t i = 0; !stop; ++i) {
      if (::send(file, &reply[i % reply.size()], 1, MSG_NOSIGNAL) < 0) break;
      std::this_thread::sleep_for(milliseconds(50));
    }
    ::close(file);
  });
  Timing timing = quick();
  timing.answer = milliseconds(400);
  EXPECT_EQ(Printer(listener.address(), timing).attributes().error().reason,
            ErrorReason::PRINTER_SILENT);
  stop = true;
  slow_client.join();
}

TEST(Printer, ReportsServersThatAreNotPrinters) {
  const Listener listener;
  std::thread server([&] {
    const int file = listener.accept();
    char buffer[4096];
    (void)!::read(file, buffer, sizeof buffer);
    const std::string reply = "HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n";
    (void)!::write(file, reply.data(), reply.size());
    // Closing a socket with unread data would reset the connection and lose the reply.
    while (::read(file, buffer, sizeof buffer) > 0) {
    }
    ::close(file);
  });
  EXPECT_EQ(Printer(listener.address()).attributes().error().reason, ErrorReason::PRINTER_NOT_IPP);
  server.join();
  const auto nobody = parse_address("ipp://127.0.0.1:1/ipp/print");
  EXPECT_EQ(Printer(*nobody).attributes().error().reason, ErrorReason::PRINTER_UNREACHABLE);
}

}  // namespace
}  // namespace hydroprint::printer
