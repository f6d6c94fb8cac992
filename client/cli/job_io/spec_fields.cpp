#include "client/cli/job_io/spec_fields.h"

#include "client/cli/program/program.h"
#include "hydroprint/v1/field_rules.pb.h"
#include "proto/flags/field_flag.h"
#include "proto/rules/field_rules.h"
#include "sim/base/check.h"

namespace hydroprint::cli {
namespace {

namespace pb = google::protobuf;

const pb::FieldDescriptor& field_of(const pb::Message& spec, const std::string& name) {
  const auto* field = spec.GetDescriptor()->FindFieldByName(name);
  HP_CHECK(field != nullptr);
  return *field;
}

pb::Message& message_in(pb::Message& spec, const pb::FieldDescriptor& field) {
  const pb::Reflection& reflection = *spec.GetReflection();
  return field.is_repeated() ? *reflection.AddMessage(&spec, &field)
                             : *reflection.MutableMessage(&spec, &field);
}

const pb::OneofDescriptor& kinds() { return *v1::Job::descriptor()->FindOneofByName("spec"); }

std::string resource_of(const pb::FieldDescriptor& field) {
  const v1::FieldRules* const rules = rules::rules_of(field);
  return rules == nullptr ? std::string() : rules->resource();
}

// Returns the value of a field for the text of its flag: completes names of jobs and calibrations
// ("7" becomes "jobs/7").
std::string completed(const pb::FieldDescriptor& field, const std::string& text) {
  const std::string resource = resource_of(field);
  if (resource == "jobs") return job_name(text);
  return resource == "calibrations" ? calibration_name(text) : text;
}

}  // namespace

pb::Message& spec_of(v1::Job& job) {
  const auto* kind = v1::Job::GetReflection()->GetOneofFieldDescriptor(job, &kinds());
  HP_CHECK(kind != nullptr);
  return *v1::Job::GetReflection()->MutableMessage(&job, kind);
}

v1::Job job_of_kind(const std::string& kind) {
  v1::Job job;
  v1::Job::GetReflection()->MutableMessage(&job, &field_of(job, kind));
  return job;
}

v1::InputFile& file_in(pb::Message& spec, const std::string& field) {
  return dynamic_cast<v1::InputFile&>(message_in(spec, field_of(spec, field)));
}

void set_text(pb::Message& spec, const std::string& field, const std::string& text) {
  spec.GetReflection()->SetString(&spec, &field_of(spec, field), text);
}

CLI::Option* add_field(CLI::App& command, pb::Message& spec, const std::string& name) {
  const auto& field = field_of(spec, name);
  CLI::Option* const option = flags::add_field(command, spec, field, completed);
  const std::string resource = resource_of(field);
  if (!resource.empty()) option->type_name(resource == "jobs" ? "JOB" : "CALIBRATION");
  return option;
}

void add_fields(CLI::App& command, pb::Message& spec) {
  const pb::Descriptor& type = *spec.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) add_field(command, spec, type.field(i)->name());
}

}  // namespace hydroprint::cli
