#include "client/cli/job_io/submit_flags.h"

#include <algorithm>

#include "client/cli/job_io/spec_fields.h"
#include "client/pose_file.h"
#include "hydroprint/v1/field_rules.pb.h"
#include "proto/flags/field_flag.h"
#include "proto/rules/field_rules.h"

namespace hydroprint::cli {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

const v1::FieldRules& rules_of(const FieldDescriptor& field) {
  const v1::FieldRules* const found = rules::rules_of(field);
  return found == nullptr ? v1::FieldRules::default_instance() : *found;
}

bool is_film(const FieldDescriptor& field) { return rules_of(field).format() == "film"; }

// Lists of files have no flag: their files are found through the references in other files.
bool has_flag(const FieldDescriptor& field) {
  return !field.is_repeated() || field.message_type() == nullptr;
}

CLI::Option* add_file(CLI::App& command, SubmitOptions& options, const FieldDescriptor& field) {
  const auto take = [&options, &field](const std::string& text) {
    options.files.emplace_back(&field, text);
  };
  return command
      .add_option_function<std::string>(flags::flag_of(field), take, rules::flag_help(field))
      ->type_name(is_film(field) ? "FILM" : "FILE");
}

CLI::Option* add_flag(CLI::App& command, SubmitOptions& options, const FieldDescriptor& field) {
  const bool is_file = field.message_type() != nullptr || is_film(field);
  return is_file ? add_file(command, options, field)
                 : add_field(command, spec_of(options.job), field.name());
}

// Makes a flag required, or exclusive with others, as the rules of its field say.
void apply_rules(CLI::App& command, const FieldDescriptor& field) {
  CLI::Option* const option = command.get_option_no_throw(flags::flag_of(field));
  if (option == nullptr) return;
  const v1::FieldRules& rules = rules_of(field);
  const auto other = [&](const std::string& name) {
    return command.get_option_no_throw(
        flags::flag_of(*field.containing_type()->FindFieldByName(name)));
  };
  for (const std::string& name : rules.replaces()) {
    if (CLI::Option* const replaced = other(name); replaced != nullptr) option->excludes(replaced);
  }
  if (!rules.required()) return;
  CLI::Option* const instead = rules.unless().empty() ? nullptr : other(rules.unless());
  if (instead == nullptr) {
    option->required();
    return;
  }
  command.parse_complete_callback([option, instead] {
    if (option->count() == 0 && instead->count() == 0)
      throw CLI::RequiredError(option->get_name() + " or " + instead->get_name());
  });
}

Status take_file(const FieldDescriptor& field, const std::string& text, Inputs& inputs,
                 Message& spec) {
  if (is_film(field)) return inputs.add_film(text, spec);
  if (field.name() == "mesh") return inputs.add_model(text, spec);
  if (field.message_type() != v1::Pose::descriptor())
    return inputs.add_to(spec, field.name(), text);
  HP_ASSIGN_OR_RETURN(const v1::Pose pose, client::read_pose_file(text));
  spec.GetReflection()->MutableMessage(&spec, &field)->CopyFrom(pose);
  return {};
}

// Returns the position of a file in the order of reading and uploading. A pose comes first, so that
// an error in it is reported before anything is uploaded. The mesh, which has the lowest field
// number, comes next, because its files keep their names.
int upload_order(const FieldDescriptor& field) {
  return field.message_type() == v1::Pose::descriptor() ? 0 : field.number();
}

}  // namespace

void add_spec_flags(CLI::App& command, SubmitOptions& options,
                    const std::vector<std::string>& only) {
  const auto& spec = *spec_of(options.job).GetDescriptor();
  for (int i = 0; i < spec.field_count(); ++i) {
    const FieldDescriptor& field = *spec.field(i);
    const bool is_wanted =
        only.empty() || std::find(only.begin(), only.end(), field.name()) != only.end();
    if (is_wanted && has_flag(field)) add_flag(command, options, field);
  }
  for (int i = 0; i < spec.field_count(); ++i) apply_rules(command, *spec.field(i));
}

Result<v1::Job> upload_inputs(Inputs& inputs, const SubmitOptions& options) {
  v1::Job job = options.job;
  auto files = options.files;
  std::stable_sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    return upload_order(*a.first) < upload_order(*b.first);
  });
  for (const auto& [field, text] : files)
    HP_RETURN_IF_ERROR(take_file(*field, text, inputs, spec_of(job)));
  return job;
}

}  // namespace hydroprint::cli
