#pragma once

#include <memory>
#include <string>

#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}

namespace hydroprint::worker {

class Flags;
class InputFolder;
class Task;

/// A verb of the program. Its options are a spec: a message that is filled in from the flags or
/// read from a file (`--spec`).
struct Verb {
  std::string name;  ///< name on the command line
  std::string summary;
  std::string examples;                            ///< end of the help text
  const google::protobuf::Message* spec_template;  ///< an empty spec
  void (*add_flags)(Flags& flags);
  /// Creates the task for a spec whose fields are in range (check_fields()). Returns fail_field()
  /// if the spec is not valid.
  Result<std::unique_ptr<Task>> (*plan)(const google::protobuf::Message& spec,
                                        const InputFolder& inputs);
  bool leaves_folder = true;  ///< false: writes its result to stdout
};

}  // namespace hydroprint::worker
