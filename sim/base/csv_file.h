#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint {

/// A table of numbers as people measure them.
struct CsvTable {
  std::filesystem::path path;
  std::size_t columns = 0;
  std::vector<double> values;  ///< finite, row after row

  [[nodiscard]] std::size_t rows() const { return values.size() / columns; }
  [[nodiscard]] const double* row(std::size_t i) const { return &values[i * columns]; }
  /// "FILE: line N", for what is wrong with a row.
  [[nodiscard]] std::string place(std::size_t row) const;
};

/// Reads a file of at most 128 MiB: a header, then rows of that many finite numbers. Blanks round
/// cells and empty lines at the end count for nothing.
/// Refuses, naming file, line and remedy: another header than this ("t_s,x_mm"), rows of anything
/// but such numbers, more than `most_rows`.
[[nodiscard]] Result<CsvTable> read_csv(const std::filesystem::path& path, std::string_view header,
                                        std::size_t most_rows);

}  // namespace hydroprint
