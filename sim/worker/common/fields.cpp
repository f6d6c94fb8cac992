#include "sim/worker/common/fields.h"

#include <fmt/format.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "hydroprint/v1/field_rules.pb.h"
#include "proto/rules/field_rules.h"

namespace hydroprint::worker {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

Status check_range(const FieldDescriptor& field, double value, Code code) {
  if (!std::isfinite(value)) return fail_field(code, field.name(), "not a finite number");
  const v1::FieldRules* const rules = rules::rules_of(field);
  if (rules == nullptr || rules::is_in_range(*rules, value)) return {};
  return fail_field(
      code, field.name(),
      fmt::format("{} is out of range. The value must be {}", value, rules::range_text(field)));
}

Status check_choice(const FieldDescriptor& field, int number) {
  if (field.enum_type()->FindValueByNumber(number) != nullptr) return {};
  return fail_field(Code::kInvalidArgument, field.name(),
                    fmt::format("{} is not a known choice. Use a name that --help lists", number));
}

Status check_field(const Message& spec, const FieldDescriptor& field) {
  if (field.is_repeated()) return {};
  const auto& reflection = *spec.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return check_range(field, reflection.GetDouble(spec, &field), Code::kOutOfRange);
    case FieldDescriptor::CPPTYPE_INT32:
      return check_range(field, reflection.GetInt32(spec, &field), Code::kInvalidArgument);
    case FieldDescriptor::CPPTYPE_ENUM:
      return check_choice(field, reflection.GetEnumValue(spec, &field));
    default:
      return {};
  }
}

}  // namespace

tl::unexpected<Error> fail_field(Code code, const std::string& field, std::string problem) {
  return tl::unexpected<Error>(Error{code, std::move(problem), {}, {{"field", field}}});
}

Error name_field(Error error, bool as_flag) {
  const auto field = error.metadata.find("field");
  if (field == error.metadata.end()) return error;
  error.message.insert(0, (as_flag ? flag_of(field->second) : field->second) + ": ");
  if (as_flag) error.metadata.erase(field);
  return error;
}

std::string flag_of(const std::string& field) {
  std::string out = "--" + field;
  std::replace(out.begin(), out.end(), '_', '-');
  return out;
}

bool is_reference(const FieldDescriptor& field) {
  const v1::FieldRules* const rules = rules::rules_of(field);
  return (rules != nullptr && !rules->resource().empty()) ||
         field.name() == "allow_stale_calibration";
}

Status check_fields(const Message& spec) {
  std::vector<const FieldDescriptor*> fields;
  spec.GetReflection()->ListFields(spec, &fields);
  for (const FieldDescriptor* field : fields) HP_RETURN_IF_ERROR(check_field(spec, *field));
  return {};
}

}  // namespace hydroprint::worker
