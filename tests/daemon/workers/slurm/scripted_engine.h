#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace hydroprint::daemon::slurm {

/// The programs of an engine: each adds its arguments to NAME.calls, and then runs NAME.does.
class ScriptedEngine {
 public:
  explicit ScriptedEngine(const std::filesystem::path& folder) : folder_(folder) {
    std::filesystem::create_directories(folder);
    for (const std::string name : {"sbatch", "squeue", "scancel"}) {
      std::ofstream(folder / name)
          << "#!/bin/sh\ncd '" << folder.string() << "'\necho \"$@\" >> " << name
          << ".calls\n[ \"$1\" = --version ] || . ./" << name << ".does\n";
      std::filesystem::permissions(folder / name, std::filesystem::perms::owner_all);
      does(name, "");
    }
    does("sbatch", "echo 1");
    ::setenv("PATH", (folder.string() + ":" + old_path_).c_str(), 1);
  }
  ~ScriptedEngine() { ::setenv("PATH", old_path_.c_str(), 1); }
  ScriptedEngine(const ScriptedEngine&) = delete;
  ScriptedEngine& operator=(const ScriptedEngine&) = delete;

  void does(const std::string& name, const std::string& shell_commands) const {
    const auto file = folder_ / (name + ".does");
    std::ofstream(file.string() + ".new") << shell_commands << "\n";
    std::filesystem::rename(file.string() + ".new", file);
  }
  void queue(const std::string& lines) const { does("squeue", "printf '" + lines + "'"); }
  /// The number of calls without --version.
  [[nodiscard]] std::ptrdiff_t calls(const std::string& name) const {
    std::ifstream file(folder_ / (name + ".calls"));
    std::ptrdiff_t count = 0;
    for (std::string line; std::getline(file, line);) count += line == "--version" ? 0 : 1;
    return count;
  }

 private:
  std::filesystem::path folder_;
  std::string old_path_ = std::getenv("PATH");
};

}  // namespace hydroprint::daemon::slurm
