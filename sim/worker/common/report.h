#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "sim/base/file_digest.h"
#include "sim/base/result.h"

// For inclusion in .cpp files only.
namespace hydroprint::worker {

using Json = nlohmann::ordered_json;

/// A file read by a run, with its role in report.json ("mesh", "pose", ...).
struct InputPath {
  std::string role;
  std::filesystem::path path;  ///< empty: not given
};

/// An input file, as listed in report.json.
struct Input {
  InputPath file;
  FileDigest digest;
};

/// The part of report.json that is common to all verbs.
struct Report {
  int threads = 1;
  std::vector<Input> inputs;
  std::vector<std::pair<std::string, double>> stage_seconds;
  double total_s = 0;
  Warnings warnings;
  std::vector<std::string> artifacts;  ///< file names, without report.json
};

/// Adds the files with their digests to the report's inputs, skipping empty paths. Returns the
/// errors of digest_file().
[[nodiscard]] Status add_inputs(Report& report, const std::vector<InputPath>& files);

/// Returns the content of report.json. `findings` contains the verb's own keys, in order. Values
/// that are not finite become null.
[[nodiscard]] std::string report_json(const std::string& verb, const Json& findings,
                                      const Report& report);

/// Returns the largest memory of this process so far.
[[nodiscard]] std::int64_t peak_memory_bytes();

/// Returns the summary for `--json` on one line: the folder, the artifacts and the verb's main
/// figures.
[[nodiscard]] std::string summary_json(const std::filesystem::path& dir, const Json& figures,
                                       const Report& report);

/// Returns "DIR: film.png report.json", the first line of a summary.
[[nodiscard]] std::string artifacts_line(const std::filesystem::path& dir, const Report& report);

}  // namespace hydroprint::worker
