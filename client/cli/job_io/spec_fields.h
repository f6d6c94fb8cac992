#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "hydroprint/v1/job.pb.h"

namespace hydroprint::cli {

// Access to the fields of a spec by their names in the API. The specs of different kinds share many
// fields. A name that the spec does not have is a bug (InvariantError).

/// Returns the spec of a job, whose kind must be set.
[[nodiscard]] google::protobuf::Message& spec_of(v1::Job& job);

/// Returns a job of a kind, for example "print_image", with an empty spec.
[[nodiscard]] v1::Job job_of_kind(const std::string& kind);

/// Returns the file in a field; for a repeated field, a new last one.
[[nodiscard]] v1::InputFile& file_in(google::protobuf::Message& spec, const std::string& field);
[[nodiscard]] v1::Pose& pose_in(google::protobuf::Message& spec);

void set_text(google::protobuf::Message& spec, const std::string& field, const std::string& text);
void set_number(google::protobuf::Message& spec, const std::string& field, double number);

/// Adds a flag that sets a field: numbers, text, the choices of an enum, a comma-separated list for
/// a repeated field, and a flag without a value for a bool. `spec` must outlive the parsing.
CLI::Option* add_field(CLI::App& command, const std::string& flag, google::protobuf::Message& spec,
                       const std::string& field, const std::string& help);

/// Adds --allow-stale-calibration.
void add_stale_flag(CLI::App& command, google::protobuf::Message& spec);

}  // namespace hydroprint::cli
