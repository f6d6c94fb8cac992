#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint {

/// A table of numbers from a CSV file.
struct CsvTable {
  std::filesystem::path path;
  std::size_t columns = 0;
  std::vector<double> values;  ///< finite, in row-major order

  [[nodiscard]] std::size_t rows() const { return values.size() / columns; }
  [[nodiscard]] const double* row(std::size_t i) const { return &values[i * columns]; }
  /// Returns "FILE: line N", for messages about a row.
  [[nodiscard]] std::string place(std::size_t row) const;
};

/// Reads a CSV file of at most 128 MiB: a header, then rows with one finite number per column.
/// Ignores blanks around cells and empty lines at the end. Returns an error with file, line and
/// remedy if the header is not `header` (such as "t_s,x_mm"), if a row is malformed, or if there
/// are more than `most_rows` rows.
[[nodiscard]] Result<CsvTable> read_csv(const std::filesystem::path& path, std::string_view header,
                                        std::size_t most_rows);

}  // namespace hydroprint
