#pragma once

#include <optional>

#include "daemon/config.h"
#include "hardware/printer/printer.h"

namespace hydroprint::daemon {

/// What a printer::Printer is made of.
struct PrinterSetup {
  printer::Address address;
  printer::Timing timing;
};

/// The printer as it is configured; none if none is.
/// @return kInvalidArgument, CONFIG_INVALID, one line that names the key
[[nodiscard]] Result<std::optional<PrinterSetup>> read_printer_setup(const Config& config);

}  // namespace hydroprint::daemon
