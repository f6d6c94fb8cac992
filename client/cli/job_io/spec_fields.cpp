#include "client/cli/job_io/spec_fields.h"

#include <algorithm>
#include <vector>

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

// Adds an option that passes its value to a function of pb::Reflection.
template <class Value, class Set>
CLI::Option* add_option(CLI::App& command, const std::string& flag, pb::Message& spec,
                        const pb::FieldDescriptor& field, const std::string& help, Set set) {
  const auto take = [&spec, &field, set](const Value& value) {
    (spec.GetReflection()->*set)(&spec, &field, value);
  };
  return command.add_option_function<Value>(flag, take, help);
}

CLI::Option* add_list(CLI::App& command, const std::string& flag, pb::Message& spec,
                      const pb::FieldDescriptor& field, const std::string& help) {
  const auto take = [&spec, &field](const std::vector<std::string>& values) {
    for (const std::string& value : values) spec.GetReflection()->AddString(&spec, &field, value);
  };
  return command.add_option_function<std::vector<std::string>>(flag, take, help)->delimiter(',');
}

// The choices are those of field_rules.h, in the order of the enum after its zero value.
CLI::Option* add_choice(CLI::App& command, const std::string& flag, pb::Message& spec,
                        const pb::FieldDescriptor& field, const std::string& help) {
  const auto choices = rules::choices(field);
  const auto take = [&spec, &field, choices](const std::string& text) {
    const auto index = std::find(choices.begin(), choices.end(), text) - choices.begin();
    const auto* value = field.enum_type()->value(static_cast<int>(index) + 1);
    spec.GetReflection()->SetEnum(&spec, &field, value);
  };
  return command.add_option_function<std::string>(flag, take, help)->check(CLI::IsMember(choices));
}

CLI::Option* add_switch(CLI::App& command, const std::string& flag, pb::Message& spec,
                        const pb::FieldDescriptor& field, const std::string& help) {
  const auto set = [&spec, &field] { spec.GetReflection()->SetBool(&spec, &field, true); };
  return command.add_flag_callback(flag, set, help);
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

v1::Pose& pose_in(pb::Message& spec) {
  return dynamic_cast<v1::Pose&>(message_in(spec, field_of(spec, "pose")));
}

void set_text(pb::Message& spec, const std::string& field, const std::string& text) {
  spec.GetReflection()->SetString(&spec, &field_of(spec, field), text);
}

void set_number(pb::Message& spec, const std::string& field, double number) {
  spec.GetReflection()->SetDouble(&spec, &field_of(spec, field), number);
}

CLI::Option* add_field(CLI::App& command, const std::string& flag, pb::Message& spec,
                       const std::string& name, const std::string& help) {
  using Type = pb::FieldDescriptor::CppType;
  const auto& field = field_of(spec, name);
  if (field.is_repeated()) return add_list(command, flag, spec, field, help);
  switch (field.cpp_type()) {
    case Type::CPPTYPE_DOUBLE:
      return add_option<double>(command, flag, spec, field, help, &pb::Reflection::SetDouble);
    case Type::CPPTYPE_INT32:
      return add_option<std::int32_t>(command, flag, spec, field, help, &pb::Reflection::SetInt32);
    case Type::CPPTYPE_ENUM:
      return add_choice(command, flag, spec, field, help);
    case Type::CPPTYPE_BOOL:
      return add_switch(command, flag, spec, field, help);
    default:
      return add_option<std::string>(command, flag, spec, field, help, &pb::Reflection::SetString);
  }
}

void add_stale_flag(CLI::App& command, pb::Message& spec) {
  add_field(command, "--allow-stale-calibration", spec, "allow_stale_calibration",
            "Use the calibration even if it is no longer valid, or is for another object");
}

}  // namespace hydroprint::cli
