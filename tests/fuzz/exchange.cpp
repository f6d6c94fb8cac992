#include "tests/fuzz/exchange.h"

#include <algorithm>
#include <array>

namespace hydroprint::fuzz {
namespace {

using drive::Function;

constexpr std::array kFunctions = {Function::kReadHolding, Function::kReadInput,
                                   Function::kWriteOne, Function::kWriteMany};
constexpr std::size_t kHead = 7;

bool is_read(Function function) {
  return function == Function::kReadHolding || function == Function::kReadInput;
}

std::uint8_t high(std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8U); }
std::uint8_t low(std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xffU); }

std::uint16_t word(std::uint8_t high, std::uint8_t low) {
  return static_cast<std::uint16_t>(high << 8U | low);
}

/// Number of words in a request, selected by `byte` within the limits of the function.
std::size_t count_of(Function function, std::uint8_t byte) {
  if (function == Function::kWriteOne) return 1;
  const int most = is_read(function) ? drive::kMaxReadWords : drive::kMaxWriteWords;
  return 1U + byte % static_cast<unsigned>(most);
}

}  // namespace

Bytes input_of(const Exchange& exchange) {
  const drive::Request& request = exchange.request;
  const auto* const function = std::find(kFunctions.begin(), kFunctions.end(), request.function);
  const std::size_t count = is_read(request.function) ? request.count : request.values.size();
  const std::uint16_t first = request.values.empty() ? std::uint16_t{0} : request.values.front();
  Bytes out = {static_cast<std::uint8_t>(Kind::kExchange),
               static_cast<std::uint8_t>(request.unit),
               static_cast<std::uint8_t>(function - kFunctions.begin()),
               high(request.address),
               low(request.address),
               static_cast<std::uint8_t>(count - 1),
               high(first),
               low(first)};
  out.insert(out.end(), exchange.reply.begin(), exchange.reply.end());
  return out;
}

Bytes input_of(std::uint8_t profile, const std::vector<Bytes>& replies) {
  Bytes out = {static_cast<std::uint8_t>(Kind::kPoll), profile};
  for (const Bytes& reply : replies) {
    out.push_back(static_cast<std::uint8_t>(reply.size()));
    out.insert(out.end(), reply.begin(), reply.end());
  }
  return out;
}

Exchange exchange_of(std::span<const std::uint8_t> input) {
  std::array<std::uint8_t, kHead> head{};
  const std::size_t known = std::min(kHead, input.size());
  std::copy_n(input.begin(), known, head.begin());
  Exchange out;
  out.request.unit = head[0];
  out.request.function = kFunctions.at(head[1] % kFunctions.size());
  out.request.address = word(head[2], head[3]);
  const std::size_t count = count_of(out.request.function, head[4]);
  if (is_read(out.request.function)) {
    out.request.count = static_cast<std::uint16_t>(count);
  } else {
    out.request.values.resize(count);
    out.request.values.front() = word(head[5], head[6]);
  }
  const auto rest = input.subspan(known);
  out.reply.assign(rest.begin(), rest.end());
  return out;
}

Bytes next_reply(std::span<const std::uint8_t>& input) {
  if (input.empty()) return {};
  const std::size_t size = std::min<std::size_t>(input[0], input.size() - 1);
  const auto reply = input.subspan(1, size);
  input = input.subspan(1 + size);
  return {reply.begin(), reply.end()};
}

}  // namespace hydroprint::fuzz
