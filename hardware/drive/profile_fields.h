#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hardware/drive/profile.h"

namespace hydroprint {
class TomlReader;
}

namespace hydroprint::drive {

/// Read the keys that several tables of a profile have in common. They record errors in the table.
[[nodiscard]] Space read_space(TomlReader& table);
[[nodiscard]] std::uint16_t read_word(TomlReader& table, std::string_view key,
                                      std::optional<std::int64_t> fallback = {});
/// @param per_unit  name of the key: "counts_per_mm"
[[nodiscard]] Format read_format(TomlReader& table, std::string_view per_unit);
[[nodiscard]] Field read_field(TomlReader table, std::string_view per_unit);

}  // namespace hydroprint::drive
