#include "sim/base/csv_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/base/input_file.h"

namespace hydroprint {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{128} << 20;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Removes the part before the next separator from the front of `text` and returns it.
std::string_view take(std::string_view& text, char separator) {
  const auto end = text.find(separator);
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return trimmed(part);
}

/// Returns the cells of a line: one more than it has separators; no cells for an empty line.
std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  if (line.empty()) return cells;
  const auto count = std::count(line.begin(), line.end(), ',') + 1;
  for (std::ptrdiff_t i = 0; i < count; ++i) cells.push_back(take(line, ','));
  return cells;
}

/// Returns the fault in a header; empty if there is none.
std::string header_objection(const std::vector<std::string_view>& cells,
                             const std::vector<std::string_view>& wanted) {
  if (cells == wanted) return {};
  for (const std::string_view name : wanted) {
    const bool is_there = std::find(cells.begin(), cells.end(), name) != cells.end();
    if (!is_there) return fmt::format("wrong header: column {} is missing", name);
  }
  return "wrong header";
}

/// Appends a row's numbers. @return the fault in the row; empty if there is none
std::string add_row(const std::vector<std::string_view>& cells,
                    const std::vector<std::string_view>& names, std::vector<double>& values) {
  if (cells.size() != names.size()) {
    return fmt::format("expected {} finite numbers, but the number of cells is {}", names.size(),
                       cells.size());
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const char* end = cells[i].data() + cells[i].size();
    double value = NAN;
    const auto parsed = std::from_chars(cells[i].data(), end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end || !std::isfinite(value)) {
      constexpr std::size_t kShown = 40;
      return fmt::format("expected {} finite numbers, but {} is '{}'", names.size(), names[i],
                         cells[i].substr(0, kShown));
    }
    values.push_back(value);
  }
  return {};
}

}  // namespace

std::string CsvTable::place(std::size_t row) const {
  return fmt::format("{}: line {}", path.string(), row + 2);  // the header is line 1
}

Result<CsvTable> read_csv(const std::filesystem::path& path, std::string_view header,
                          std::size_t most_rows) {
  HP_ASSIGN_OR_RETURN(const std::string content, read_text_file(path, kMaxBytes));
  const std::vector<std::string_view> names = cells_of(header);
  std::string_view text = content;
  std::size_t line_number = 1;
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    return fail(Code::kInvalidArgument,
                fmt::format("{}: line {}: {}. {}", path.string(), line_number, what, remedy));
  };
  const std::string write = "Write " + std::string(header);
  if (const std::string what = header_objection(cells_of(take(text, '\n')), names); !what.empty()) {
    return refuse(what, write);
  }
  CsvTable table{path, names.size(), {}};
  while (text.find_first_not_of(" \t\r\n") != std::string_view::npos) {
    ++line_number;
    const std::string_view line = take(text, '\n');
    if (table.rows() == most_rows) {
      return refuse("too many rows", fmt::format("Use at most {} rows", most_rows));
    }
    if (const std::string what = add_row(cells_of(line), names, table.values); !what.empty()) {
      return refuse(what, write);
    }
  }
  return table;
}

}  // namespace hydroprint
