#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/worker/options.h"

// For inclusion in .cpp files only.
namespace hydroprint::worker {

/// Options as typed: what cannot stand in Options is settled in `settle`.
struct Typed {
  Options options;
  std::string depth = "full";
  std::string model = "sheet";
  std::string artifacts = "all";
  std::vector<std::string> free;
  std::string paper = "A4";
  std::string colours = "rgb";
  std::vector<std::string> formats;
};

/// An option that names a file. (Left to itself, the library would cut paths at blanks.)
CLI::Option* add_path(CLI::App& app, const std::string& flag, std::filesystem::path& path,
                      const std::string& description, const std::string& type = "FILE");

/// A verb of the program; `typed` has it once it is on the command line.
CLI::App& add_verb(CLI::App& program, Typed& typed, Verb verb, const char* name,
                   const char* description, const char* examples);

void add_threads(CLI::App& app, Options& options);

/// What every verb takes that leaves an artifact folder.
void add_run(CLI::App& app, Options& options);

void add_film(CLI::App& app, Options& options);

/// An object as it is held.
void add_object(CLI::App& app, Options& options);

/// simulate, predict, preview, fit, validate.
void add_dip_verbs(CLI::App& program, Typed& typed);

/// print-image, template.
void add_print_verbs(CLI::App& program, Typed& typed);

/// Takes what they say of paper and files; refuses what makes no sense.
[[nodiscard]] Status settle_print(Typed& typed);

/// calibrate, calibrate-camera, fuse.
void add_sight_verbs(CLI::App& program, Typed& typed);

}  // namespace hydroprint::worker
