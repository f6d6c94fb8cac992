#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace CLI {
class App;
}  // namespace CLI
namespace google::protobuf {
class FieldDescriptor;
class Message;
}  // namespace google::protobuf

namespace hydroprint::worker {

/// The flags of a verb, from the fields of its spec and of the flat messages in it (proto/flags):
/// `--ink-passes` fills `ink_passes`.
class Flags {
 public:
  /// `app` and `spec` must stay valid while the command line is parsed.
  Flags(CLI::App& app, google::protobuf::Message& spec) : app_(app), spec_(spec) {}

  /// Adds the flags of all fields, or of those named in `only`. Skips threads, lists of files, and
  /// references that only a daemon resolves.
  void add_fields(const std::vector<std::string>& only = {});
  /// Makes the flag of a field required.
  void require(const std::string& field);
  /// Adds a required flag for folders. The spec gets the path of `file` in each folder.
  void require_folders(const std::string& field, const std::string& file);

  /// Adds a flag for a folder. The spec gets the paths of these files in it.
  void add_folder(const std::string& field, const std::vector<std::string>& files);

  /// Reads the pose from the file of `--pose`, the dips from that of `--immersions` and the paint
  /// from that of `--paint`, if the flag was given. Called after parsing. Returns the errors of
  /// read_pose_file(), read_immersions_file() and read_paint_file().
  [[nodiscard]] Status read_files();
  /// The file of `--pose` or `--immersions`.
  [[nodiscard]] const std::filesystem::path& pose_file() const { return pose_file_; }

 private:
  void add_field(const google::protobuf::FieldDescriptor& field);
  void add_file(const google::protobuf::FieldDescriptor& field);
  [[nodiscard]] Status read_poses();
  void require(const google::protobuf::FieldDescriptor& field);
  [[nodiscard]] const google::protobuf::FieldDescriptor& field(const std::string& name) const;

  CLI::App& app_;
  google::protobuf::Message& spec_;
  std::filesystem::path pose_file_, paint_file_;
  google::protobuf::Message* paint_ = nullptr;  ///< receives the paint; null: no such flag
};

/// Adds the flags of all fields.
void add_field_flags(Flags& flags);

}  // namespace hydroprint::worker
