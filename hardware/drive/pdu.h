#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hardware/drive/profile.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// The four Modbus functions that drives are spoken to with.
enum class Function : std::uint8_t {
  kReadHolding = 3,
  kReadInput = 4,
  kWriteOne = 6,
  kWriteMany = 16,
};

/// Most words of one request (Modbus application protocol 6.3, 6.12).
inline constexpr int kMaxReadWords = 125;
inline constexpr int kMaxWriteWords = 123;

/// One request: reads `count` words or writes `values`, from `address` on.
struct Request {
  int unit = 1;
  Function function = Function::kReadHolding;
  std::uint16_t address = 0;
  std::uint16_t count = 0;            ///< of reads
  std::vector<std::uint16_t> values;  ///< of writes
};

/// Unit, function and data as they go on the wire, without the transport's header and checksum.
[[nodiscard]] std::vector<std::uint8_t> encode_request(const Request& request);

/// The words that a reply to a read holds; none for a reply to a write, which must repeat address
/// and count or value. `reply` is unit, function and data, without the transport's header and
/// checksum, and may be anything. Refuses with kDataLoss, reason REPLY_INVALID, what is no reply to
/// `request`, and with kFailedPrecondition, reason DRIVE_REFUSED and metadata `exception`, what the
/// drive refuses; exceptions 5 and 6 (busy) are kAborted, reason DRIVE_BUSY.
[[nodiscard]] Result<std::vector<std::uint16_t>> decode_reply(const Request& request,
                                                              std::span<const std::uint8_t> reply);

}  // namespace hydroprint::drive
