#pragma once

#include <optional>
#include <string_view>

#include "sim/mesh/read/ply_header.h"

namespace hydroprint::mesh {

/// The numbers behind a PLY header, one after the other.
class PlyBody {
 public:
  /// `bytes` must outlive the reader.
  PlyBody(std::string_view bytes, const PlyHeader& header)
      : rest_(bytes), format_(header.format), line_end_(header.line_end) {}

  /// Begins the next item: in ASCII the next line that is not blank.
  void next_item();

  /// Returns the next number of the item; NaN or infinity as the file has them (in ASCII NaN for
  /// all their spellings); nullopt if it is missing or malformed.
  [[nodiscard]] std::optional<double> next(const PlyType& type);

 private:
  std::string_view rest_;
  std::string_view item_;  ///< the rest of an ASCII item's line
  PlyHeader::Format format_;
  char line_end_;
};

}  // namespace hydroprint::mesh
