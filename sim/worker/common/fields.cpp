#include "sim/worker/common/fields.h"

#include <fmt/format.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "hydroprint/v1/field_rules.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/flags/field_flag.h"
#include "proto/rules/check.h"
#include "proto/rules/field_rules.h"

namespace hydroprint::worker {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

Status check_fields(const Message& spec, const std::string& path);

Status check_range(const FieldDescriptor& field, const std::string& place, double value,
                   Code code) {
  if (!std::isfinite(value)) return fail_field(code, place, "not a finite number");
  const v1::FieldRules* const rules = rules::rules_of(field);
  if (rules == nullptr || rules::is_in_range(*rules, value)) return {};
  return fail_field(
      code, place,
      fmt::format("{} is out of range. The value must be {}", value, rules::range_text(field)));
}

Status check_choice(const FieldDescriptor& field, const std::string& place, int number) {
  if (field.enum_type()->FindValueByNumber(number) != nullptr) return {};
  return fail_field(Code::kInvalidArgument, place,
                    fmt::format("{} is not a known choice. Use a name that --help lists", number));
}

/// Checks a list of setups, which contain no files.
Status check_list(const Message& spec, const FieldDescriptor& field, const std::string& place) {
  const auto& reflection = *spec.GetReflection();
  const v1::FieldRules* const rules = rules::rules_of(field);
  const int count = reflection.FieldSize(spec, &field);
  if (rules != nullptr && rules->max_items() > 0 && count > rules->max_items()) {
    return fail_field(Code::kInvalidArgument, place,
                      fmt::format("{} values. Give at most {}", count, rules->max_items()));
  }
  for (int i = 0; i < count; ++i) {
    const auto violations = rules::check(reflection.GetRepeatedMessage(spec, &field, i), {},
                                         fmt::format("{}[{}]", place, i));
    if (violations.empty()) continue;
    return fail_field(Code::kInvalidArgument, violations.front().field, violations.front().problem);
  }
  return {};
}

Status check_field(const Message& spec, const FieldDescriptor& field, const std::string& place) {
  const bool is_message = field.message_type() != nullptr;
  if (is_message && field.message_type() == v1::InputFile::descriptor()) return {};
  if (field.is_repeated()) return is_message ? check_list(spec, field, place) : Status();
  const auto& reflection = *spec.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return check_range(field, place, reflection.GetDouble(spec, &field), Code::kOutOfRange);
    case FieldDescriptor::CPPTYPE_INT32:
      return check_range(field, place, reflection.GetInt32(spec, &field), Code::kInvalidArgument);
    case FieldDescriptor::CPPTYPE_ENUM:
      return check_choice(field, place, reflection.GetEnumValue(spec, &field));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return flags::is_flat(field) ? check_fields(reflection.GetMessage(spec, &field), place + ".")
                                   : Status();
    default:
      return {};
  }
}

Status check_fields(const Message& spec, const std::string& path) {
  std::vector<const FieldDescriptor*> fields;
  spec.GetReflection()->ListFields(spec, &fields);
  for (const FieldDescriptor* field : fields)
    HP_RETURN_IF_ERROR(check_field(spec, *field, path + field->name()));
  return {};
}

}  // namespace

Error in_message(const std::string& message, Error error) {
  if (!error.field.empty()) error.field.insert(0, message + ".");
  return error;
}

std::string flag_of(const std::string& field) {
  const std::size_t list = field.find('[');
  if (list != std::string::npos) return flag_of(field.substr(0, list)) + ": " + field.substr(list);
  std::string out = "--" + field.substr(field.rfind('.') + 1);
  std::replace(out.begin(), out.end(), '_', '-');
  return out;
}

bool is_reference(const FieldDescriptor& field) {
  const v1::FieldRules* const rules = rules::rules_of(field);
  return (rules != nullptr && !rules->resource().empty()) ||
         field.name() == "allow_stale_calibration";
}

Status check_fields(const Message& spec) { return check_fields(spec, ""); }

}  // namespace hydroprint::worker
