#pragma once

#include <optional>

#include "daemon/config/config.h"
#include "hardware/printer/printer.h"

namespace hydroprint::daemon {

/// What a printer::Printer is made of.
struct PrinterConfig {
  printer::Address address;
  printer::Timing timing;
};

/// The printer as it is configured; none if none is.
/// @return kInvalidArgument, CONFIG_INVALID, one line that names the key
[[nodiscard]] Result<std::optional<PrinterConfig>> read_printer_setup(const Config& config);

}  // namespace hydroprint::daemon
