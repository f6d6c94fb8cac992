#include "client/cli/job_io/submit_flags.h"

#include <algorithm>
#include <map>

#include "client/cli/job_io/spec_fields.h"
#include "client/pose_file.h"
#include "hydroprint/v1/field_rules.pb.h"
#include "proto/flags/field_flag.h"
#include "proto/paint/paint_file.h"
#include "proto/rules/field_rules.h"
#include "sim/base/immersions_file.h"

namespace hydroprint::cli {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

const v1::FieldRules& rules_of(const FieldDescriptor& field) {
  const v1::FieldRules* const found = rules::rules_of(field);
  return found == nullptr ? v1::FieldRules::default_instance() : *found;
}

bool is_film(const FieldDescriptor& field) { return rules_of(field).format() == "film"; }

bool is_list_of_dips(const FieldDescriptor& field) {
  return field.is_repeated() && field.message_type() == v1::DipSetup::descriptor();
}

bool is_paint(const FieldDescriptor& field) {
  return field.message_type() == v1::Paint::descriptor();
}

// Lists of files have no flag: their files are found through the references in other files.
bool has_flag(const FieldDescriptor& field) {
  return !field.is_repeated() || field.message_type() == nullptr || is_list_of_dips(field);
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
                 : add_field(command, flags::holder_of(spec_of(options.job), field), field.name());
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

Status take_film(const FieldDescriptor& field, const std::string& text, Inputs& inputs,
                 Message& spec) {
  Message* with_files = &spec;
  for (const FieldDescriptor* other : flags::fields_of(*spec.GetDescriptor())) {
    if (other->name() == "extra_files") with_files = &flags::holder_of(spec, *other);
  }
  return inputs.add_film(text, flags::holder_of(spec, field), *with_files);
}

Status take_dips(const FieldDescriptor& field, const std::string& file, Message& spec) {
  HP_ASSIGN_OR_RETURN(const std::vector<ListedDip> dips, read_immersions_file(file));
  for (const ListedDip& dip : dips)
    set_dip(dip, static_cast<v1::DipSetup&>(*spec.GetReflection()->AddMessage(&spec, &field)));
  return {};
}

// Adds the pictures of a paint, each once.
Status take_paint(const FieldDescriptor& field, const std::string& file, Inputs& inputs,
                  Message& holder) {
  HP_ASSIGN_OR_RETURN(v1::Paint paint, paint::read_paint_file(file));
  std::map<std::string, v1::InputFile> added;
  for (v1::PaintLayer& layer : *paint.mutable_layers()) {
    if (!layer.has_picture()) continue;
    const std::string path = layer.picture().name();
    if (!added.contains(path)) {
      HP_ASSIGN_OR_RETURN(added[path], inputs.add(path));
    }
    *layer.mutable_picture() = added[path];
  }
  holder.GetReflection()->MutableMessage(&holder, &field)->CopyFrom(paint);
  return {};
}

Status take_file(const FieldDescriptor& field, const std::string& text, Inputs& inputs,
                 Message& spec) {
  if (is_film(field)) return take_film(field, text, inputs, spec);
  if (is_list_of_dips(field)) return take_dips(field, text, spec);
  Message& holder = flags::holder_of(spec, field);
  if (field.name() == "mesh") return inputs.add_model(text, holder);
  if (is_paint(field)) return take_paint(field, text, inputs, holder);
  if (field.message_type() != v1::Pose::descriptor())
    return inputs.add_to(holder, field.name(), text);
  HP_ASSIGN_OR_RETURN(const v1::Pose pose, client::read_pose_file(text));
  holder.GetReflection()->MutableMessage(&holder, &field)->CopyFrom(pose);
  return {};
}

// Returns the position of a file in the order of reading and uploading. Poses come first, so that
// an error in them is reported before anything is uploaded. The mesh, which is the first field,
// comes next, because its files keep their names.
std::ptrdiff_t upload_order(const FieldDescriptor& field, const Message& spec) {
  if (field.message_type() == v1::Pose::descriptor() || is_list_of_dips(field)) return -1;
  const auto all = flags::fields_of(*spec.GetDescriptor());
  return std::find(all.begin(), all.end(), &field) - all.begin();
}

}  // namespace

void add_spec_flags(CLI::App& command, SubmitOptions& options,
                    const std::vector<std::string>& only) {
  const auto fields = flags::fields_of(*spec_of(options.job).GetDescriptor());
  for (const FieldDescriptor* field : fields) {
    const bool is_wanted =
        only.empty() || std::find(only.begin(), only.end(), field->name()) != only.end();
    if (is_wanted && has_flag(*field)) add_flag(command, options, *field);
  }
  for (const FieldDescriptor* field : fields) apply_rules(command, *field);
}

Result<v1::Job> upload_inputs(Inputs& inputs, const SubmitOptions& options) {
  v1::Job job = options.job;
  const Message& spec = spec_of(job);
  auto files = options.files;
  std::stable_sort(files.begin(), files.end(), [&](const auto& a, const auto& b) {
    return upload_order(*a.first, spec) < upload_order(*b.first, spec);
  });
  // An error in a paint is reported before anything is uploaded.
  for (const auto& [field, text] : files) {
    if (!is_paint(*field)) continue;
    if (const auto paint = paint::read_paint_file(text); !paint)
      return tl::unexpected(paint.error());
  }
  for (const auto& [field, text] : files)
    HP_RETURN_IF_ERROR(take_file(*field, text, inputs, spec_of(job)));
  return job;
}

}  // namespace hydroprint::cli
