#include "hardware/drive/profile_fields.h"

#include <cmath>

#include "sim/base/toml_reader.h"

namespace hydroprint::drive {
namespace {

constexpr double kLeastPerUnit = 1e-9;
constexpr double kMostPerUnit = 1e9;

}  // namespace

Space read_space(TomlReader& table) {
  return table.choice("space", {"holding", "input"}) == 0 ? Space::kHolding : Space::kInput;
}

std::uint16_t read_word(TomlReader& table, std::string_view key,
                        std::optional<std::int64_t> fallback) {
  return static_cast<std::uint16_t>(table.integer(key, 0, 0xffff, fallback));
}

Format read_format(TomlReader& table, std::string_view per_unit) {
  Format format;
  format.words = static_cast<int>(table.integer("words", 1, 2));
  format.is_signed = table.flag("signed", false);
  format.low_word_first = table.flag("low_word_first", false);
  format.inverse = table.flag("inverse", false);
  format.per_unit = table.number(per_unit, -kMostPerUnit, kMostPerUnit);
  if (std::abs(format.per_unit) < kLeastPerUnit) {
    table.refuse(per_unit, "is 0 or too close to 0. Use the number of counts per unit");
  }
  return format;
}

Field read_field(TomlReader table, std::string_view per_unit) {
  Field field;
  field.space = read_space(table);
  field.address = read_word(table, "address");
  field.format = read_format(table, per_unit);
  if (field.address + field.format.words > 0x10000) {
    table.refuse("address",
                 "is too high: the value ends after register 65535. Use a lower address");
  }
  return field;
}

}  // namespace hydroprint::drive
