// Replies of a drive are untrusted. decode_reply, decode_state and the codec must never crash, must
// accept exactly the valid replies, and must decode them correctly.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>

#include "hardware/drive/reply_reader.h"
#include "hardware/drive/state_decoder.h"
#include "hardware/drive/word_codec.h"
#include "tests/fuzz/exchange.h"
#include "tests/fuzz/expect.h"

namespace hydroprint::fuzz {
namespace {

using drive::DriveProfile;
using drive::Format;
using drive::Function;
using drive::Request;
using Input = std::span<const std::uint8_t>;
using Words = std::vector<std::uint16_t>;

// Limits of counts per unit that the profile reader accepts.
constexpr double kLeastPerUnit = 1e-9;
constexpr double kMostPerUnit = 1e9;

const std::vector<DriveProfile>& profiles() {
  static const std::vector<DriveProfile> all = [] {
    std::vector<DriveProfile> out;
    for (const char* name : {"virtual", "leadshine_em2rs", "oriental_az"}) {
      auto profile =
          drive::read_drive_profile(std::string(HYDROPRINT_PROFILES "/") + name + ".toml");
      HP_EXPECT(profile);
      out.push_back(std::move(*profile));
    }
    return out;
  }();
  return all;
}

/// The only valid reply that contains `words` (for a read) or confirms a write.
Bytes good_reply(const Request& request, const Words& words) {
  if (!is_read(request)) {
    Bytes out = encode_request(request);
    out.resize(6);
    return out;
  }
  Bytes out = {static_cast<std::uint8_t>(request.unit), static_cast<std::uint8_t>(request.function),
               static_cast<std::uint8_t>(2 * request.count)};
  for (const std::uint16_t word : words) {
    out.push_back(static_cast<std::uint8_t>(word >> 8U));
    out.push_back(static_cast<std::uint8_t>(word & 0xffU));
  }
  return out;
}

bool is_refusal(const Request& request, const Bytes& reply) {
  return reply.size() == 3 && reply[0] == request.unit &&
         reply[1] == (static_cast<unsigned>(request.function) | 0x80U);
}

void check_error(const Request& request, const Bytes& reply, const Error& error) {
  HP_EXPECT(error.message.find('\n') == std::string::npos);
  if (!is_refusal(request, reply)) {
    HP_EXPECT(error.reason == ErrorReason::REPLY_INVALID && error.code == Code::kDataLoss);
    return;
  }
  const bool busy = reply[2] == 5 || reply[2] == 6;
  HP_EXPECT(error.reason == (busy ? ErrorReason::DRIVE_BUSY : ErrorReason::DRIVE_REFUSED));
  HP_EXPECT(error.metadata.at("exception") == std::to_string(reply[2]));
}

/// Decodes a reply. It must be accepted if and only if it is, byte for byte, the valid reply with
/// the decoded words.
Result<Words> decode_checked(const Request& request, const Bytes& reply) {
  auto words = decode_reply(request, reply);
  if (words) {
    HP_EXPECT(words->size() == (is_read(request) ? request.count : 0U));
    HP_EXPECT(reply == good_reply(request, *words));
    return words;
  }
  check_error(request, reply, words.error());
  Words any(request.count);
  for (std::size_t i = 0; i < any.size() && 4 + 2 * i < reply.size(); ++i) {
    any[i] = static_cast<std::uint16_t>(reply[3 + 2 * i] << 8U | reply[4 + 2 * i]);
  }
  HP_EXPECT(reply != good_reply(request, any));
  return words;
}

/// Takes the bytes as they arrive on a line, in two pieces. A reply that is found must be in them,
/// frame and all.
void try_line(const Request& request, const Bytes& received, drive::Framing framing) {
  constexpr std::uint16_t kTransaction = 7;
  drive::ReplyReader reader(request, kTransaction, framing, {});
  const Input all(received);
  const std::size_t half = all.size() / 2;
  auto found = reader.add(all.first(half));
  if (found == drive::ReplyReader::Found::kNothing) found = reader.add(all.subspan(half));
  HP_EXPECT(reader.trouble().find('\n') == std::string::npos);
  if (found != drive::ReplyReader::Found::kReply || !*reader.reply()) return;
  const Bytes frame = frame_of(framing, kTransaction, good_reply(request, **reader.reply()));
  HP_EXPECT(std::search(all.begin(), all.end(), frame.begin(), frame.end()) != all.end());
}

void try_exchange(Input input) {
  const Exchange exchange = exchange_of(input);
  const Bytes sent = encode_request(exchange.request);
  HP_EXPECT(sent.size() >= 6 && sent.size() <= 253);
  (void)decode_checked(exchange.request, exchange.reply);
  for (const auto framing : {drive::Framing::kRtu, drive::Framing::kTcp}) {
    try_line(exchange.request, exchange.reply, framing);
    try_line(exchange.request, frame_of(framing, 7, exchange.reply), framing);
  }
}

/// Encoding a decoded number must give the original registers.
void check_number(const Format& format, const Words& words) {
  const double value = drive::decode(format, words);
  HP_EXPECT(!std::isnan(value));
  if (std::isinf(value)) {
    HP_EXPECT(format.inverse);
    return;
  }
  const auto again = drive::encode(format, value);
  HP_EXPECT(again && *again == words);
}

const Words& block_of(const DriveProfile& profile, const std::vector<Words>& blocks,
                      drive::Space space, std::uint16_t address, std::size_t& at) {
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const drive::Block& block = profile.blocks[i];
    if (block.space != space || address < block.address || address >= block.address + block.count) {
      continue;
    }
    at = address - block.address;
    return blocks[i];
  }
  std::abort();
}

void check_field(const DriveProfile& profile, const std::vector<Words>& blocks,
                 const drive::Field& field, double told) {
  std::size_t at = 0;
  const Words& block = block_of(profile, blocks, field.space, field.address, at);
  const auto first = block.begin() + static_cast<std::ptrdiff_t>(at);
  const Words words(first, first + field.format.words);
  HP_EXPECT(told == drive::decode(field.format, words));
  check_number(field.format, words);
}

void check_bit(const DriveProfile& profile, const std::vector<Words>& blocks,
               drive::StatusBit which, bool told) {
  const auto& place = profile.bit(which);
  if (!place) {
    HP_EXPECT(!told);
    return;
  }
  std::size_t at = 0;
  const unsigned word = block_of(profile, blocks, place->space, place->address, at)[at];
  HP_EXPECT(told == (((word >> static_cast<unsigned>(place->bit)) % 2 == 1) != place->inverted));
}

void check_state(const DriveProfile& profile, const std::vector<Words>& blocks,
                 const drive::DriveState& state) {
  check_field(profile, blocks, profile.position, state.position_mm);
  if (profile.velocity) check_field(profile, blocks, *profile.velocity, state.velocity_mm_per_s);
  check_field(profile, blocks, profile.alarm_code, state.alarm_code);
  HP_EXPECT(state.demand_mm.has_value() == profile.demand.has_value());
  if (profile.demand) check_field(profile, blocks, *profile.demand, *state.demand_mm);
  using enum drive::StatusBit;
  check_bit(profile, blocks, kEnabled, state.enabled);
  check_bit(profile, blocks, kHomed, state.homed);
  check_bit(profile, blocks, kMoving, state.moving);
  check_bit(profile, blocks, kAlarm, state.alarm);
  check_bit(profile, blocks, kPositiveEnd, state.positive_end);
  check_bit(profile, blocks, kNegativeEnd, state.negative_end);
  check_bit(profile, blocks, kHomeSwitch, state.home_switch);
  check_bit(profile, blocks, kStopInput, state.stop_input);
  HP_EXPECT((state.alarm_code == 0) == state.alarm_text.empty());
  HP_EXPECT((state.alarm_code == 0) == state.alarm_hint.empty());
}

void try_poll(Input input) {
  if (input.empty()) return;
  const DriveProfile& profile = profiles()[input[0] % profiles().size()];
  Input rest = input.subspan(1);
  std::vector<Words> blocks;
  for (const drive::Block& block : profile.blocks) {
    const Function function =
        block.space == drive::Space::kHolding ? Function::kReadHolding : Function::kReadInput;
    auto words =
        decode_checked({profile.unit, function, block.address, block.count, {}}, next_reply(rest));
    if (!words) return;
    blocks.push_back(std::move(*words));
  }
  check_state(profile, blocks, drive::decode_state(profile, blocks));
}

template <class T>
T take(Input& input) {
  T out{};
  const std::size_t size = std::min(sizeof out, input.size());
  std::memcpy(&out, input.data(), size);
  input = input.subspan(size);
  return out;
}

/// A number that can be encoded must be decoded to within half a count of its value.
void check_value(const Format& format, double value) {
  const auto words = drive::encode(format, value);
  if (!words) {
    HP_EXPECT(words.error().reason == ErrorReason::LIMIT_EXCEEDED);
    return;
  }
  HP_EXPECT(words->size() == static_cast<std::size_t>(format.words));
  const double again = drive::decode(format, *words);
  const auto counts = [&](double x) {
    return format.inverse ? format.per_unit / x : x * format.per_unit;
  };
  HP_EXPECT(std::abs(counts(again) - counts(value)) <= 0.5 + 1e-5 || again == value);
}

void try_number(Input input) {
  Format format;
  const auto choice = take<std::uint8_t>(input);
  format.words = 1 + (choice & 1U);
  format.is_signed = (choice & 2U) != 0;
  format.low_word_first = (choice & 4U) != 0;
  format.inverse = (choice & 8U) != 0;
  format.per_unit = take<double>(input);
  const double size = std::abs(format.per_unit);
  if (!(size >= kLeastPerUnit && size <= kMostPerUnit)) return;
  check_value(format, take<double>(input));
  Words words(static_cast<std::size_t>(format.words));
  for (std::uint16_t& word : words) word = take<std::uint16_t>(input);
  check_number(format, words);
}

void try_input(Input input) {
  if (input.empty()) return;
  switch (static_cast<Kind>(input[0] % kKinds)) {
    case Kind::kExchange:
      return try_exchange(input.subspan(1));
    case Kind::kPoll:
      return try_poll(input.subspan(1));
    case Kind::kNumber:
      return try_number(input.subspan(1));
  }
}

}  // namespace
}  // namespace hydroprint::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hydroprint::fuzz::try_input({data, size});
  return 0;
}
