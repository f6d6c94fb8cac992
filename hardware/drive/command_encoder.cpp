#include "hardware/drive/command_encoder.h"

#include <fmt/format.h>

#include "hardware/drive/word_codec.h"

namespace hydroprint::drive {
namespace {

bool takes_speed(Command which) {
  return which == Command::kMove || which == Command::kJogPositive ||
         which == Command::kJogNegative;
}

Status check_speed(const DriveProfile& profile, double speed_mm_per_s) {
  if (speed_mm_per_s > 0 && speed_mm_per_s <= profile.max_speed_mm_per_s) return {};
  return fail(
      Code::kOutOfRange,
      fmt::format("a speed of {:g} mm/s is out of range. Use a speed above 0 and up to {:g} mm/s",
                  speed_mm_per_s, profile.max_speed_mm_per_s),
      ErrorReason::LIMIT_EXCEEDED);
}

Result<std::vector<std::uint16_t>> words_for(const DriveProfile& profile, const Value& value,
                                             double position_mm, double speed_mm_per_s) {
  switch (value.quantity) {
    case Quantity::kPosition:
      return encode(profile.position_format, position_mm);
    case Quantity::kSpeed:
      return encode(profile.speed_format, speed_mm_per_s);
    case Quantity::kNegativeSpeed:
      return encode(profile.speed_format, -speed_mm_per_s);
    case Quantity::kAcceleration:
      return encode(profile.acceleration_format, profile.acceleration_mm_per_s2);
    case Quantity::kDeceleration:
      return encode(profile.deceleration_format, profile.acceleration_mm_per_s2);
    case Quantity::kWord:
      break;
  }
  return std::vector<std::uint16_t>{value.word};
}

}  // namespace

Result<std::vector<Request>> requests_for(const DriveProfile& profile, Command which,
                                          double position_mm, double speed_mm_per_s) {
  if (takes_speed(which)) HP_RETURN_IF_ERROR(check_speed(profile, speed_mm_per_s));
  std::vector<Request> out;
  for (const Write& write : profile.command(which)) {
    Request request{profile.unit, Function::kWriteMany, write.address, 0, {}};
    for (const Value& value : write.values) {
      HP_ASSIGN_OR_RETURN(const auto words, words_for(profile, value, position_mm, speed_mm_per_s));
      request.values.insert(request.values.end(), words.begin(), words.end());
    }
    if (request.values.size() == 1 && !profile.single_writes_by_fc16) {
      request.function = Function::kWriteOne;
    }
    out.push_back(std::move(request));
  }
  return out;
}

}  // namespace hydroprint::drive
