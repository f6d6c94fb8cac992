#pragma once

#include <optional>

#include "daemon/config/config.h"
#include "hardware/printer/printer.h"

namespace hydroprint::daemon {

/// The arguments of a printer::Printer.
struct PrinterConfig {
  printer::Address address;
  printer::Timing timing;
};

/// Reads the printer's configuration; nullopt if no printer is configured.
/// @return kInvalidArgument, CONFIG_INVALID, one line that names the key
[[nodiscard]] Result<std::optional<PrinterConfig>> read_printer_setup(const Config& config);

}  // namespace hydroprint::daemon
