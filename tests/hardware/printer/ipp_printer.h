#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "hardware/printer/printer.h"
#include "tests/support/process.h"

namespace hydroprint::printer {

/// CUPS's ippeveprinter in its own folder: a real IPP Everywhere printer, which passes every job to
/// a command and keeps the received files.
class IppPrinter {
 public:
  /// @param command  a shell command that "prints" the file named by its last argument
  explicit IppPrinter(const std::string& command);

  /// A command that prints until finish() is called or this object is destroyed.
  static constexpr const char* kUntilFinished =
      "while [ -e \"$0\" ]; do [ -e \"$0.end\" ] && exit 0; sleep 0.1; done\nexit 1";
  void finish() const;

  [[nodiscard]] Address address() const;
  /// Kills the printer and its current job at once.
  void pull_the_plug();
  /// The only received file.
  [[nodiscard]] std::filesystem::path spooled() const;
  [[nodiscard]] std::filesystem::path folder() const { return folder_.path(); }

 private:
  testing::TemporaryFolder folder_;
  int port_ = 0;
  /// ippeveprinter does not start without a system bus for its announcement.
  std::unique_ptr<testing::Process> bus_;
  std::unique_ptr<testing::Process> process_;
};

}  // namespace hydroprint::printer
