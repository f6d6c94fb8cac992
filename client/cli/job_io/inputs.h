#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "client/assets.h"
#include "hydroprint/v1/spec.pb.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Uploads a file; on a terminal, shows the progress on standard error.
[[nodiscard]] Result<client::Uploaded> upload_shown(client::Connection& connection,
                                                    const std::filesystem::path& file);

/// Uploads the files of one job and gives each a name that is unique within the job.
class Inputs {
 public:
  explicit Inputs(client::Connection& connection) : connection_(connection) {}

  /// Adds the mesh and the files it refers to, under the names it uses. Notes about references that
  /// cannot be sent go to standard error.
  [[nodiscard]] Status add_model(const std::filesystem::path& mesh,
                                 google::protobuf::Message& spec);

  /// Adds a file that no other file refers to.
  [[nodiscard]] Result<v1::InputFile> add(const std::filesystem::path& file);
  /// Same, and sets a field of the spec to it. An empty path leaves the field unset.
  [[nodiscard]] Status add_to(google::protobuf::Message& spec, const std::string& field,
                              const std::filesystem::path& file);

  /// Adds folders written by hydroprint-capture, each under its own name: "view1/frames.json", ...
  [[nodiscard]] Result<std::vector<v1::InputFile>> add_frames(
      const std::vector<std::filesystem::path>& folders);

  /// Sets the spec's film, unless it is empty; uploads the file of a polygon.
  [[nodiscard]] Status add_film(const std::string& film, google::protobuf::Message& spec);

 private:
  [[nodiscard]] Result<v1::InputFile> add_as(const std::string& name,
                                             const std::filesystem::path& file);

  client::Connection& connection_;
  std::set<std::string> names_;
};

}  // namespace hydroprint::cli
