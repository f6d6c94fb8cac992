#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "hydroprint/v1/job.pb.h"

namespace hydroprint::cli {

// Access to the fields of a spec by their names in the API, because the specs of different kinds
// share many fields. It is a bug if the spec does not have a field of that name (InvariantError).

/// Returns the spec of a job, whose kind must be set.
[[nodiscard]] google::protobuf::Message& spec_of(v1::Job& job);

/// Creates a job of a kind, for example "print_image", with an empty spec.
[[nodiscard]] v1::Job job_of_kind(const std::string& kind);

/// Returns the file in a field; appends one to a repeated field.
[[nodiscard]] v1::InputFile& file_in(google::protobuf::Message& spec, const std::string& field);

void set_text(google::protobuf::Message& spec, const std::string& field, const std::string& text);

/// Adds the flag of a field (proto/flags). Names of jobs and calibrations are completed: "7"
/// becomes "jobs/7". `spec` must outlive the parsing.
CLI::Option* add_field(CLI::App& command, google::protobuf::Message& spec,
                       const std::string& field);

/// Adds the flags of all fields.
void add_fields(CLI::App& command, google::protobuf::Message& spec);

}  // namespace hydroprint::cli
