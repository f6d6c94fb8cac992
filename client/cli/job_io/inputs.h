#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "client/assets.h"
#include "client/job.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Uploads a file; on a terminal, shows how far it is on standard error.
[[nodiscard]] Result<client::Uploaded> upload_shown(client::Connection& connection,
                                                    const std::filesystem::path& file);

/// Uploads the files of one job and finds a name within the job for each, so that no two are alike.
class Inputs {
 public:
  explicit Inputs(client::Connection& connection) : connection_(connection) {}

  /// The mesh and what it refers to, under names by which it finds them; notes about what it
  /// refers to in vain go to standard error.
  [[nodiscard]] Status add_model(const std::filesystem::path& mesh, client::Spec& spec);

  /// A file that nothing refers to by name; nothing for an empty path.
  [[nodiscard]] Result<std::optional<client::InputFile>> add(const std::filesystem::path& file);

  /// Folders that hydroprint-capture wrote, each under its own name: "view1/frames.json", ...
  [[nodiscard]] Result<std::vector<client::InputFile>> add_frames(
      const std::vector<std::filesystem::path>& folders);

  /// The worker's --film; the file of a polygon is uploaded.
  [[nodiscard]] Result<std::string> add_film(const std::string& film, client::Spec& spec);

 private:
  [[nodiscard]] Result<client::InputFile> add_as(const std::string& name,
                                                 const std::filesystem::path& file);

  client::Connection& connection_;
  std::set<std::string> names_;
};

}  // namespace hydroprint::cli
