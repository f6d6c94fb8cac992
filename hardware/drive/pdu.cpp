#include "hardware/drive/pdu.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "hardware/drive/frame.h"

namespace hydroprint::drive {
namespace {

tl::unexpected<Error> invalid(const std::string& what) {
  return tl::unexpected(invalid_reply(what));
}

std::string_view exception_text(int exception) {
  constexpr std::array<std::string_view, 7> kTexts = {
      "",
      "function not supported",
      "no such register",
      "value not allowed",
      "not possible in the present state",
      "accepted, but not finished yet",
      "busy",
  };
  const auto at = static_cast<std::size_t>(exception);
  return at < kTexts.size() ? kTexts.at(at) : "";
}

tl::unexpected<Error> refused(const Request& request, int exception) {
  const bool busy = exception == 5 || exception == 6;
  const std::string_view text = exception_text(exception);
  Error error{
      busy ? Code::kAborted : Code::kFailedPrecondition,
      fmt::format("the drive refuses the request for register {} with exception {}{}. {}",
                  request.address, exception, text.empty() ? "" : fmt::format(" ({})", text),
                  busy ? "Try again" : "Check the drive's state and its profile"),
      busy ? ErrorReason::DRIVE_BUSY : ErrorReason::DRIVE_REFUSED,
      {{"exception", std::to_string(exception)}}};
  return tl::unexpected(std::move(error));
}

Result<std::vector<std::uint16_t>> decode_words(const Request& request,
                                                std::span<const std::uint8_t> reply) {
  const std::size_t bytes = std::size_t{2} * request.count;
  if (reply.size() != 3 + bytes || reply[2] != bytes) return invalid("has the wrong length");
  std::vector<std::uint16_t> words(request.count);
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = word_at(reply, 3 + 2 * i);
  return words;
}

/// Returns the second word of the reply to a write: the value or the number of values.
std::uint16_t confirmed_word(const Request& request) {
  return request.function == Function::kWriteOne
             ? request.values.at(0)
             : static_cast<std::uint16_t>(request.values.size());
}

Result<std::vector<std::uint16_t>> decode_confirmation(const Request& request,
                                                       std::span<const std::uint8_t> reply) {
  if (reply.size() != 6) return invalid("has the wrong length");
  if (word_at(reply, 2) != request.address || word_at(reply, 4) != confirmed_word(request)) {
    return invalid("confirms a different request");
  }
  return std::vector<std::uint16_t>();
}

}  // namespace

Error invalid_reply(const std::string& what) {
  return {Code::kDataLoss,
          "the drive's reply " + what +
              ". If this persists, check cable, termination, baud rate and unit id",
          ErrorReason::REPLY_INVALID,
          {}};
}

bool replies_look_alike(const Request& a, const Request& b) {
  if (a.function != b.function) return false;
  if (is_read(a)) return a.count == b.count;
  return a.address == b.address && confirmed_word(a) == confirmed_word(b);
}

std::vector<std::uint8_t> encode_request(const Request& request) {
  std::vector<std::uint8_t> out = {static_cast<std::uint8_t>(request.unit),
                                   static_cast<std::uint8_t>(request.function)};
  put_word(out, request.address);
  switch (request.function) {
    case Function::kReadHolding:
    case Function::kReadInput:
      put_word(out, request.count);
      break;
    case Function::kWriteOne:
      put_word(out, request.values.at(0));
      break;
    case Function::kWriteMany:
      put_word(out, request.values.size());
      out.push_back(static_cast<std::uint8_t>(2 * request.values.size()));
      for (const std::uint16_t value : request.values) put_word(out, value);
      break;
  }
  return out;
}

Result<std::vector<std::uint16_t>> decode_reply(const Request& request,
                                                std::span<const std::uint8_t> reply) {
  const auto function = static_cast<std::uint8_t>(request.function);
  if (reply.size() < 3) return invalid("is cut off");
  if (reply[0] != request.unit) return invalid("comes from another unit");
  if (reply[1] == (function | kExceptionFlag) && reply.size() == 3) {
    return refused(request, reply[2]);
  }
  if (reply[1] != function) return invalid("is for another function");
  return is_read(request) ? decode_words(request, reply) : decode_confirmation(request, reply);
}

}  // namespace hydroprint::drive
