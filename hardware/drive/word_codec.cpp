#include "hardware/drive/word_codec.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace hydroprint::drive {
namespace {

double least_raw(const Format& format) {
  if (!format.is_signed) return 0;
  return format.words == 1 ? std::numeric_limits<std::int16_t>::min()
                           : std::numeric_limits<std::int32_t>::min();
}

double largest_raw(const Format& format) {
  const double all = std::exp2(16.0 * format.words);
  return (format.is_signed ? all / 2 : all) - 1;
}

}  // namespace

Result<std::vector<std::uint16_t>> encode(const Format& format, double value) {
  const double raw = std::round(format.inverse ? format.per_unit / value : value * format.per_unit);
  if (!(raw >= least_raw(format) && raw <= largest_raw(format)) || (raw == 0 && value != 0)) {
    return fail(Code::kOutOfRange,
                fmt::format("the drive's registers cannot hold {:g}. Use another value", value),
                ErrorReason::LIMIT_EXCEEDED);
  }
  const auto bits = static_cast<std::uint32_t>(static_cast<std::int64_t>(raw));
  const auto low = static_cast<std::uint16_t>(bits & 0xffffU);
  if (format.words == 1) return std::vector<std::uint16_t>{low};
  const auto high = static_cast<std::uint16_t>(bits >> 16U);
  return format.low_word_first ? std::vector<std::uint16_t>{low, high}
                               : std::vector<std::uint16_t>{high, low};
}

double decode(const Format& format, std::span<const std::uint16_t> words) {
  std::uint32_t bits = words[0];
  if (format.words == 2) {
    bits = format.low_word_first ? bits | static_cast<std::uint32_t>(words[1]) << 16U
                                 : bits << 16U | words[1];
  }
  double raw = bits;
  if (format.is_signed) {
    raw = format.words == 1 ? static_cast<std::int16_t>(bits) : static_cast<std::int32_t>(bits);
  }
  return format.inverse ? format.per_unit / raw : raw / format.per_unit;
}

int words_of(const DriveProfile& profile, Quantity quantity) {
  switch (quantity) {
    case Quantity::kPosition:
      return profile.position_format.words;
    case Quantity::kSpeed:
    case Quantity::kNegativeSpeed:
      return profile.speed_format.words;
    case Quantity::kAcceleration:
      return profile.acceleration_format.words;
    case Quantity::kDeceleration:
      return profile.deceleration_format.words;
    case Quantity::kWord:
      break;
  }
  return 1;
}

}  // namespace hydroprint::drive
