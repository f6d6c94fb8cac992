#include "proto/flags/field_flag.h"

#include <algorithm>
#include <vector>

#include "hydroprint/v1/field_rules.pb.h"
#include "proto/rules/field_rules.h"
#include "sim/base/check.h"

namespace hydroprint::flags {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

// Adds a flag whose value is stored in the field with a setter of Reflection.
template <class Value, class Set>
CLI::Option* add_value(CLI::App& command, Message& spec, const FieldDescriptor& field, Set set) {
  const auto take = [&spec, &field, set](const Value& value) {
    (spec.GetReflection()->*set)(&spec, &field, value);
  };
  return command.add_option_function<Value>(flag_of(field), take);
}

CLI::Option* add_text(CLI::App& command, Message& spec, const FieldDescriptor& field,
                      const ReadText& read) {
  const auto take = [&spec, &field, read](const std::string& text) {
    spec.GetReflection()->SetString(&spec, &field, read ? read(field, text) : text);
  };
  return command.add_option_function<std::string>(flag_of(field), take);
}

CLI::Option* add_list(CLI::App& command, Message& spec, const FieldDescriptor& field,
                      const ReadText& read) {
  const auto take = [&spec, &field, read](const std::vector<std::string>& texts) {
    for (const std::string& text : texts)
      spec.GetReflection()->AddString(&spec, &field, read ? read(field, text) : text);
  };
  return command.add_option_function<std::vector<std::string>>(flag_of(field), take)
      ->delimiter(',');
}

CLI::Option* add_number_or_word(CLI::App& command, Message& spec, const FieldDescriptor& field,
                                const std::string& word) {
  const auto take = [&spec, &field, word](const std::string& text) {
    double value = 0;
    if (text == word) {
      spec.GetReflection()->ClearField(&spec, &field);
    } else if (CLI::detail::lexical_cast(text, value)) {
      spec.GetReflection()->SetDouble(&spec, &field, value);
    } else {
      throw CLI::ValidationError(flag_of(field),
                                 "'" + text + "' is not a number. Give a number, or " + word);
    }
  };
  return command.add_option_function<std::string>(flag_of(field), take);
}

CLI::Option* add_double(CLI::App& command, Message& spec, const FieldDescriptor& field) {
  const std::string usual = rules::default_text(field);
  double value = 0;
  if (usual.empty() || CLI::detail::lexical_cast(usual, value))
    return add_value<double>(command, spec, field, &Reflection::SetDouble);
  return add_number_or_word(command, spec, field, usual);
}

// Joins names with "or": "sheet or stokes".
std::string alternatives(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : " or ") + name;
  return out;
}

// Accepts the names. Help texts show them as "{sheet,stokes}", from which completion scripts read
// the choices (client/cli/commands/completion.cpp).
CLI::Validator one_of(const std::vector<std::string>& names) {
  const auto check = [names](const std::string& text) {
    const bool is_known = std::find(names.begin(), names.end(), text) != names.end();
    return is_known ? std::string() : "'" + text + "' is unknown. Use " + alternatives(names);
  };
  return {check, "{" + CLI::detail::join(names, ",") + "}"};
}

// rules::choices() lists the values of the enum in order, without the zero value.
CLI::Option* add_choice(CLI::App& command, Message& spec, const FieldDescriptor& field) {
  const auto names = rules::choices(field);
  const auto take = [&spec, &field, names](const std::string& text) {
    const auto index = std::find(names.begin(), names.end(), text) - names.begin();
    const auto* value = field.enum_type()->value(static_cast<int>(index) + 1);
    spec.GetReflection()->SetEnum(&spec, &field, value);
  };
  return command.add_option_function<std::string>(flag_of(field), take)->check(one_of(names));
}

CLI::Option* add_switch(CLI::App& command, Message& spec, const FieldDescriptor& field) {
  return command.add_flag_callback(
      flag_of(field), [&spec, &field] { spec.GetReflection()->SetBool(&spec, &field, true); });
}

CLI::Option* add_option(CLI::App& command, Message& spec, const FieldDescriptor& field,
                        const ReadText& read) {
  if (field.is_repeated()) return add_list(command, spec, field, read)->type_name("NAME[,NAME]");
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return add_switch(command, spec, field);
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return add_double(command, spec, field)->type_name("N");
    case FieldDescriptor::CPPTYPE_INT32:
      return add_value<std::int32_t>(command, spec, field, &Reflection::SetInt32)->type_name("N");
    case FieldDescriptor::CPPTYPE_ENUM:
      return add_choice(command, spec, field)->type_name("NAME");
    default:
      return add_text(command, spec, field, read)->type_name("TEXT");
  }
}

}  // namespace

std::string flag_of(const FieldDescriptor& field) { return "--" + rules::flag_of(field); }

bool is_flat(const FieldDescriptor& field) {
  const v1::FieldRules* const rules = rules::rules_of(field);
  return rules != nullptr && rules->flat();
}

std::vector<const FieldDescriptor*> fields_of(const Descriptor& spec) {
  std::vector<const FieldDescriptor*> out;
  for (int i = 0; i < spec.field_count(); ++i) {
    const FieldDescriptor& field = *spec.field(i);
    if (is_flat(field)) {
      const auto inner = fields_of(*field.message_type());
      out.insert(out.end(), inner.begin(), inner.end());
    } else {
      out.push_back(&field);
    }
  }
  return out;
}

Message& holder_of(Message& spec, const FieldDescriptor& field) {
  const Descriptor& type = *spec.GetDescriptor();
  if (field.containing_type() == &type) return spec;
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& flat = *type.field(i);
    if (is_flat(flat) && flat.message_type() == field.containing_type())
      return *spec.GetReflection()->MutableMessage(&spec, &flat);
  }
  HP_CHECK(false && "a field of another spec");
  return spec;
}

CLI::Option* add_field(CLI::App& command, Message& spec, const FieldDescriptor& field,
                       const ReadText& read) {
  return add_option(command, spec, field, read)->description(rules::flag_help(field));
}

}  // namespace hydroprint::flags
