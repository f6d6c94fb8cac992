#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hardware/drive/profile.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// The four Modbus functions that are used with drives.
enum class Function : std::uint8_t {
  kReadHolding = 3,
  kReadInput = 4,
  kWriteOne = 6,
  kWriteMany = 16,
};

/// Maximum number of words per request (Modbus application protocol 6.3, 6.12).
inline constexpr int kMaxReadWords = 125;
inline constexpr int kMaxWriteWords = 123;

/// A request that reads `count` words or writes `values`, starting at `address`.
struct Request {
  int unit = 1;
  Function function = Function::kReadHolding;
  std::uint16_t address = 0;
  std::uint16_t count = 0;            ///< reads only
  std::vector<std::uint16_t> values;  ///< writes only
};

[[nodiscard]] inline bool is_read(const Request& request) {
  return request.function == Function::kReadHolding || request.function == Function::kReadInput;
}

/// Returns whether a valid reply to one of the requests, other than an exception, is also one to
/// the other: reads of equally many words, or the same write.
[[nodiscard]] bool replies_look_alike(const Request& a, const Request& b);

/// Returns the error REPLY_INVALID (kDataLoss) with the remedy for a reply that is `what`: "is cut
/// off".
[[nodiscard]] Error invalid_reply(const std::string& what);

/// Encodes unit, function and data as sent, without the transport's header and checksum.
[[nodiscard]] std::vector<std::uint8_t> encode_request(const Request& request);

/// Returns the words of a reply to a read; empty for a reply to a write, which must repeat address
/// and count or value. `reply` is untrusted: unit, function and data, without the transport's
/// header and checksum. Returns kDataLoss, reason REPLY_INVALID, if it is not a reply to `request`.
/// Returns kFailedPrecondition, reason DRIVE_REFUSED with metadata `exception`, if the drive
/// rejects the request. Exceptions 5 and 6 (busy) become kAborted, reason DRIVE_BUSY.
[[nodiscard]] Result<std::vector<std::uint16_t>> decode_reply(const Request& request,
                                                              std::span<const std::uint8_t> reply);

}  // namespace hydroprint::drive
