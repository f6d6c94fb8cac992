#pragma once

#include <cups/cups.h>

#include <chrono>
#include <functional>
#include <memory>
#include <span>

#include "hardware/printer/address.h"
#include "sim/base/result.h"

// For inclusion in .cpp files only.
namespace hydroprint::printer {

struct IppDelete {
  void operator()(ipp_t* ipp) const { ippDelete(ipp); }
};
using Ipp = std::unique_ptr<ipp_t, IppDelete>;

/// Time limits of one exchange.
struct ExchangeTiming {
  std::chrono::milliseconds connect{5000};
  /// Timeout for a response after the last byte is sent, and for every write.
  std::chrono::milliseconds answer{15000};
  std::chrono::milliseconds whole{60000};  ///< timeout for the whole exchange
};

/// Sends one request, followed by a document, over a new connection and waits for the printer's
/// reply, whatever its status. Ends in bounded time, except for host name lookup, which depends on
/// the resolver. Returns kUnavailable with PRINTER_UNREACHABLE (nothing was sent), PRINTER_SILENT
/// (connected, but no response in time), PRINTER_LOST (the connection broke) or PRINTER_NOT_IPP, or
/// kCancelled with CANCELLED.
/// @param gives_up  called ten times a second while connected; the exchange ends if it returns true
[[nodiscard]] Result<Ipp> exchange(const Address& address, const ExchangeTiming& timing,
                                   const std::function<bool()>& gives_up, ipp_t* request,
                                   std::span<const unsigned char> document = {});

}  // namespace hydroprint::printer
