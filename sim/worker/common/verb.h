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

/// One thing that the program can do. Its options come as a spec, a message that the flags or a
/// file (`--spec`) fill in.
struct Verb {
  std::string name;  ///< as on the command line
  std::string summary;
  std::string examples;                            ///< end of the help text
  const google::protobuf::Message* spec_template;  ///< an empty spec
  void (*add_flags)(Flags& flags);
  /// Turns a spec whose fields are in range (check_fields()) into options and a task. Fails with
  /// fail_field() if it cannot.
  Result<std::unique_ptr<Task>> (*plan)(const google::protobuf::Message& spec,
                                        const InputFolder& inputs);
  bool leaves_folder = true;  ///< false: answers on stdout
};

}  // namespace hydroprint::worker
