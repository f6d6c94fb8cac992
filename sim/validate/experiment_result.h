#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::validate {

/// The range in which a figure must lie.
struct Limit {
  double least = -1e300, most = 1e300;
  std::string why;  ///< reason for the limit
};

/// A number measured by an experiment.
struct Figure {
  std::string name;  ///< for programs: a to z, 0 to 9 and _, with its unit at the end
  std::string text;  ///< name for display
  std::string unit;  ///< "mm", "%", ...; empty: no unit
  double value = 0;
  std::optional<Limit> limit;  ///< nullopt: no limit is known

  [[nodiscard]] bool passes() const {
    return !limit || (value >= limit->least && value <= limit->most);
  }
};

/// A table of text.
struct Table {
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// A picture that was passed to the sink.
struct Picture {
  std::string file;  ///< file name, in the report's folder
  std::string caption;
  int width = 0, height = 0;
};

/// The result of one experiment.
struct Experiment {
  std::string name;               ///< name for --only
  std::string title;              ///< title for display
  std::string paper;              ///< place in the paper: "section 7.1, Fig. 12"
  std::vector<std::string> text;  ///< paragraphs
  std::vector<Figure> figures;
  std::vector<Table> tables;
  std::vector<Picture> pictures;
};

}  // namespace hydroprint::validate
