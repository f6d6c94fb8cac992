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

/// How long one exchange may take.
struct ExchangeTiming {
  std::chrono::milliseconds connect{5000};
  std::chrono::milliseconds answer{15000};  ///< from the last byte sent; also for every write
  std::chrono::milliseconds whole{60000};   ///< all of it, however the printer dawdles
};

/// Why an exchange failed.
inline constexpr const char* kUnreachable = "PRINTER_UNREACHABLE";  ///< nothing was sent
inline constexpr const char* kSilent = "PRINTER_SILENT";  ///< connected, but no answer in time
inline constexpr const char* kLost = "PRINTER_LOST";      ///< the connection broke
inline constexpr const char* kNoIpp = "PRINTER_NOT_IPP";  ///< it answered something else
inline constexpr const char* kLeft = "PRINTER_LEFT";      ///< whoever asked gave up

/// Sends one request, with a document behind it, over a connection of its own and waits for the
/// reply: the printer's, whatever its status says. Ends in bounded time, but for the look-up of the
/// host's name, which the resolver bounds. Refuses with kUnavailable (kLeft: kCancelled) and one of
/// the reasons above.
/// @param gives_up  asked ten times a second once there is a connection; true breaks it off
[[nodiscard]] Result<Ipp> exchange(const Address& address, const ExchangeTiming& timing,
                                   const std::function<bool()>& gives_up, ipp_t* request,
                                   std::span<const unsigned char> document = {});

}  // namespace hydroprint::printer
