#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "sim/base/result.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI
namespace google::protobuf {
class FieldDescriptor;
class Message;
}  // namespace google::protobuf

namespace hydroprint::worker {

/// Details of a flag for the help text. Empty texts are derived from the field's type.
struct FlagHelp {
  std::string default_value = {};
  std::string type = {};
};

/// The flags of a verb. Each flag fills in the spec's field of the same name: `--ink-passes` fills
/// in `ink_passes`.
class Flags {
 public:
  /// Both must stay valid while the command line is parsed.
  Flags(CLI::App& app, google::protobuf::Message& spec) : app_(app), spec_(spec) {}

  /// Adds a flag for a number, choice, text, switch, list of names or file.
  void add(const std::string& field, const std::string& description, const FlagHelp& help = {});
  /// Adds a required flag for a file.
  void require(const std::string& field, const std::string& description, const FlagHelp& help = {});

  /// Adds `--pose FILE.json`; read_pose() reads the file.
  void add_pose();
  /// Adds `--depth-mm D|full`.
  void add_depth();
  /// Adds a flag for at most `most` folders; 0: any number. The spec receives the path of `file` in
  /// each folder.
  void require_folders(const std::string& field, const std::string& file,
                       const std::string& description, int most);

  /// Called after parsing: reads the pose from the file of `--pose`, if the flag was given. Returns
  /// the errors of read_pose_file().
  [[nodiscard]] Status read_pose();
  [[nodiscard]] const std::filesystem::path& pose_file() const { return pose_file_; }

 private:
  CLI::Option& add_option(const google::protobuf::FieldDescriptor& field,
                          const std::string& description);
  CLI::Option& add_text(const std::string& field, const std::string& description,
                        const std::function<void(const std::string&)>& set);
  [[nodiscard]] const google::protobuf::FieldDescriptor& field(const std::string& name) const;

  CLI::App& app_;
  google::protobuf::Message& spec_;
  std::filesystem::path pose_file_;
};

/// Formats a default value for FlagHelp: "300", "0.5".
[[nodiscard]] std::string default_text(double value);

}  // namespace hydroprint::worker
