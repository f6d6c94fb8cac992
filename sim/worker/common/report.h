#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}  // namespace google::protobuf
namespace hydroprint::v1 {
class RunFacts;
}  // namespace hydroprint::v1

// For inclusion in .cpp files only.
namespace hydroprint::worker {

/// A file read by a run, with its role in report.json ("mesh", "pose", ...).
struct InputPath {
  std::string role;
  std::filesystem::path path;  ///< empty: not given
};

/// Adds the files with their digests to the inputs of a run, skipping empty paths. Returns the
/// errors of digest_file().
[[nodiscard]] Status add_inputs(v1::RunFacts& run, const std::vector<InputPath>& files);

/// Prepares a message for JSON: clears numbers that are not finite, and lists with such numbers,
/// and repairs text that is not UTF-8, as in names of files.
void make_writable(google::protobuf::Message& message);

/// Writes a message as a JSON file (json_file_of) after make_writable(). Returns the errors of
/// image::write_artifact().
[[nodiscard]] Status write_message(const std::filesystem::path& path,
                                   google::protobuf::Message& message);

/// Returns "DIR: film.png report.json", the first line of a summary.
[[nodiscard]] std::string artifacts_line(const std::filesystem::path& dir, const v1::RunFacts& run);

}  // namespace hydroprint::worker
