#include "sim/worker/motion_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "sim/base/input_file.h"

namespace hydroprint::worker {
namespace {

constexpr std::size_t kMaxRows = 1'000'000;
constexpr std::size_t kMaxBytes = std::size_t{128} << 20;
constexpr double kMaxOffset_mm = 1e4;
constexpr std::string_view kHeader = "t_s,x_mm,y_mm,z_mm";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Cuts the part before the next separator off the front.
std::string_view take(std::string_view& text, char separator) {
  const auto end = text.find(separator);
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return trimmed(part);
}

std::string without_blanks(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    if (!out.empty()) out += ',';
    out += take(text, ',');
  }
  return out;
}

std::optional<std::array<double, 4>> four_numbers(std::string_view line) {
  std::array<double, 4> out{};
  for (double& value : out) {
    const std::string_view cell = take(line, ',');
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
    if (!std::isfinite(value)) return std::nullopt;
  }
  if (!line.empty()) return std::nullopt;
  return out;
}

/// What is wrong with a row after the one before it; empty if nothing is.
std::string objection(const waterline::Motion& motion, const waterline::Motion::Row& row) {
  if (row.offset_mm.cwiseAbs().maxCoeff() > kMaxOffset_mm || row.immersion_mm > kMaxOffset_mm) {
    return "farther than 1e4 mm from the start. Is it in mm?";
  }
  if (motion.rows.empty()) return {};
  if (row.time_s <= motion.rows.back().time_s) {
    return "t_s does not increase. Sort the rows by time and remove repeated ones";
  }
  if (row.immersion_mm < motion.rows.back().immersion_mm) {
    return "z_mm rises. Cut the file to the way down";
  }
  return {};
}

}  // namespace

Result<waterline::Motion> read_motion(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const std::string content, read_text_file(path, kMaxBytes));
  std::string_view text = content;
  std::size_t line_number = 1;
  const auto refuse = [&](const std::string& what) {
    return fail(Code::kInvalidArgument,
                path.string() + ": line " + std::to_string(line_number) + ": " + what);
  };
  if (without_blanks(take(text, '\n')) != kHeader) {
    return refuse("not the header. Write " + std::string(kHeader));
  }
  waterline::Motion motion;
  std::array<double, 4> start{};
  while (!text.empty()) {
    ++line_number;
    const std::string_view line = take(text, '\n');
    if (line.empty() && trimmed(text).empty()) break;  // blank end of the file
    const auto numbers = four_numbers(line);
    if (!numbers) return refuse("not four finite numbers. Write t_s,x_mm,y_mm,z_mm");
    if (motion.rows.empty()) start = *numbers;
    if (motion.rows.size() == kMaxRows) return refuse("too many rows. Use at most 1000000");
    const auto& [time_s, x_mm, y_mm, z_mm] = *numbers;
    const waterline::Motion::Row row{
        time_s - start[0], start[3] - z_mm, {x_mm - start[1], y_mm - start[2]}};
    if (const std::string what = objection(motion, row); !what.empty()) return refuse(what);
    motion.rows.push_back(row);
  }
  if (motion.rows.size() < 2) return refuse("fewer than two rows. Give the whole way down");
  return motion;
}

}  // namespace hydroprint::worker
