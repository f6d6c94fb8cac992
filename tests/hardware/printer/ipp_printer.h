#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "hardware/printer/printer.h"
#include "tests/support/process.h"

namespace hydroprint::printer {

/// CUPS's ippeveprinter in a folder of its own: a real IPP Everywhere printer, which hands every
/// job to a command and keeps what it was sent.
class IppPrinter {
 public:
  /// @param command  of a shell, that "prints" the file named by its last argument
  explicit IppPrinter(const std::string& command);

  /// A command that prints until finish(), or until this is gone.
  static constexpr const char* kUntilFinished =
      "while [ -e \"$0\" ]; do [ -e \"$0.end\" ] && exit 0; sleep 0.1; done\nexit 1";
  void finish() const;

  [[nodiscard]] Address address() const;
  /// Ends it, and the job in its hands, at once.
  void pull_the_plug();
  /// The one file it was sent.
  [[nodiscard]] std::filesystem::path spooled() const;
  [[nodiscard]] std::filesystem::path folder() const { return folder_.path(); }

 private:
  testing::TemporaryFolder folder_;
  int port_ = 0;
  /// It will not start without a system bus to announce itself on.
  std::unique_ptr<testing::Process> bus_;
  std::unique_ptr<testing::Process> process_;
};

}  // namespace hydroprint::printer
