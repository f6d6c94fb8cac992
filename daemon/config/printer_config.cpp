#include "daemon/config/printer_config.h"

#include <utility>

namespace hydroprint::daemon {

Result<std::optional<PrinterConfig>> read_printer_setup(const Config& config) {
  if (config.printer_address.empty()) return std::optional<PrinterConfig>();
  auto address = printer::parse_address(config.printer_address);
  if (!address) {
    return fail(Code::kInvalidArgument, "printer.address: " + address.error().message,
                ErrorReason::CONFIG_INVALID);
  }
  PrinterConfig setup{std::move(*address), {}};
  setup.timing.answer = std::chrono::seconds(config.printer_patience_s);
  setup.timing.patience = std::chrono::seconds(config.printer_patience_s);
  setup.timing.job = std::chrono::seconds(config.printer_time_limit_s);
  return std::optional(std::move(setup));
}

}  // namespace hydroprint::daemon
