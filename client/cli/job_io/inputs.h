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

/// Uploads the files of a job and gives each a name that is unique within the job.
class Inputs {
 public:
  explicit Inputs(client::Connection& connection) : connection_(connection) {}

  /// Adds the mesh and the files that it refers to, keeping their relative names. Prints notes
  /// about references that cannot be sent to standard error.
  [[nodiscard]] Status add_model(const std::filesystem::path& mesh,
                                 google::protobuf::Message& spec);

  /// Adds a file that is not referred to by other files.
  [[nodiscard]] Result<v1::InputFile> add(const std::filesystem::path& file);
  /// Adds a file and stores it in a field of the spec. An empty path leaves the field unset.
  [[nodiscard]] Status add_to(google::protobuf::Message& spec, const std::string& field,
                              const std::filesystem::path& file);

  /// Adds the files of folders written by hydroprint-capture: those of the first folder as
  /// "view1/frames.json", ...
  [[nodiscard]] Result<std::vector<v1::InputFile>> add_frames(
      const std::vector<std::filesystem::path>& folders);

  /// Sets the film of a spec, or of a message in it, unless `film` is empty; uploads the file of a
  /// polygon.
  /// @param with_files  the message that has the extra files
  [[nodiscard]] Status add_film(const std::string& film, google::protobuf::Message& spec,
                                google::protobuf::Message& with_files);

 private:
  [[nodiscard]] Result<v1::InputFile> add_as(const std::string& name,
                                             const std::filesystem::path& file);

  client::Connection& connection_;
  std::set<std::string> names_;
};

}  // namespace hydroprint::cli
