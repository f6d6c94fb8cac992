#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::validate {

/// What a figure is held against.
struct Limit {
  double least = -1e300, most = 1e300;
  std::string why;  ///< where the limit comes from
};

/// A number that an experiment found.
struct Figure {
  std::string name;  ///< for programs: a to z, 0 to 9 and _, its unit at the end
  std::string text;  ///< for people
  std::string unit;  ///< "mm", "%", ...; empty: none
  double value = 0;
  std::optional<Limit> limit;  ///< none: nothing to judge it by

  [[nodiscard]] bool passes() const {
    return !limit || (value >= limit->least && value <= limit->most);
  }
};

/// A table of text, one row of cells below the other.
struct Table {
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// A picture that was handed over to be written.
struct Picture {
  std::string file;  ///< its name, beside the report
  std::string caption;
  int width = 0, height = 0;
};

/// What one experiment has to tell.
struct Experiment {
  std::string name;               ///< as --only takes it
  std::string title;              ///< for people
  std::string paper;              ///< where the paper has it: "section 7.1, Fig. 12"
  std::vector<std::string> text;  ///< paragraphs
  std::vector<Figure> figures;
  std::vector<Table> tables;
  std::vector<Picture> pictures;
};

}  // namespace hydroprint::validate
