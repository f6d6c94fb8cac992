#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/job.h"

namespace hydroprint::v1 {
class InputFile;
}

namespace hydroprint::daemon {

/// The shortest text that reads back as the same number.
[[nodiscard]] std::string text_of(double value);

/// Collects the flags and files of one work, and the first thing that is wrong with them. `field`
/// is a field of the spec, for messages; `name` is the worker's flag.
class WorkBuilder {
 public:
  /// @param verb  the worker's: "print-image"
  explicit WorkBuilder(std::string verb);

  /// What must hold for there to be a work.
  void require(const Status& status);
  /// As require(): the field is wrong, and this is why.
  void refuse(const std::string& field, const std::string& why);
  void flag(const std::string& name, const std::string& value);
  /// One that takes no value.
  void bare_flag(const std::string& name);
  void pose(std::string json);
  /// At least `least`; above 0 where there is none.
  void number(const std::string& field, const std::string& name, double value, double most,
              double least = 0);
  /// A length that may be 0.
  void length(const std::string& field, const std::string& name, double length_mm, double most_mm);
  void whole(const std::string& field, const std::string& name, std::int32_t value,
             std::int32_t least, std::int32_t most);
  void check_whole(const std::string& field, std::int32_t value, std::int32_t least,
                   std::int32_t most);
  /// That there are so many, all finite.
  void check_numbers(const std::string& field, const std::vector<double>& numbers,
                     std::size_t count);
  /// Some words; none: no flag.
  void text(const std::string& field, const std::string& name, const std::string& text);
  /// A file that goes with a flag (an empty one: with none, others refer to it).
  void file(const std::string& field, const std::string& name, const v1::InputFile& input);
  /// Where a field of the spec is: "print_image.film".
  [[nodiscard]] std::string path(const std::string& field) const;
  [[nodiscard]] const std::vector<InputFile>& inputs() const { return work_.inputs; }

  /// @return what was wrong first; NAME_INVALID if a file's name stands for two
  [[nodiscard]] Result<Work> build();

 private:
  Work work_;
  Status status_;
};

}  // namespace hydroprint::daemon
