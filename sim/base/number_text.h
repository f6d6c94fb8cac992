#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace hydroprint {

/// A number for people: three digits, or all digits before the point: "0.123", "12.3", "1234".
[[nodiscard]] std::string three_digits(double value);

/// A share for people: "12.3 %".
[[nodiscard]] std::string percent(double share);

/// A size for people: "312 B", "4.2 MB".
[[nodiscard]] std::string format_bytes(std::int64_t bytes);

/// A time for people: "0:07", "12:30", "1:02:03"; "0:00" if it is negative.
[[nodiscard]] std::string format_duration(std::chrono::seconds time);

/// The shortest text that reads back as the same number, for files: "0.1", "1e+05".
[[nodiscard]] std::string shortest_text(double value);

}  // namespace hydroprint
