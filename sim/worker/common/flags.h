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

/// Details of a flag in the help text; empty: by the field's type.
struct FlagHelp {
  std::string default_value = {};
  std::string type = {};
};

/// The flags of a verb. Each fills the spec's field of the same name: `--ink-passes` fills
/// `ink_passes`.
class Flags {
 public:
  /// Both must live while the command line is parsed.
  Flags(CLI::App& app, google::protobuf::Message& spec) : app_(app), spec_(spec) {}

  /// A flag for a number, choice, text, switch, list of names or file.
  void add(const std::string& field, const std::string& description, const FlagHelp& help = {});
  /// A flag for a file that must be given.
  void require(const std::string& field, const std::string& description, const FlagHelp& help = {});

  /// `--pose FILE.json`, which read_pose() reads.
  void add_pose();
  /// `--depth-mm D|full`
  void add_depth();
  /// A flag for folders, at most `most`; 0: any number. Each stands for the file of that name in
  /// it.
  void require_folders(const std::string& field, const std::string& file,
                       const std::string& description, int most);

  /// After parsing: fills in the pose from the file that `--pose` names, if it names one. Fails as
  /// read_pose_file() does.
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

/// A default value for Flags::Help: "300", "0.5".
[[nodiscard]] std::string default_text(double value);

}  // namespace hydroprint::worker
