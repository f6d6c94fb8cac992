#include "daemon/rest/json_text.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/util/json_util.h>

#include <cmath>
#include <vector>

#include "daemon/rest/json_check.h"
#include "daemon/rest/percent.h"

namespace hydroprint::rest {
namespace {

namespace pb = google::protobuf;
using Type = pb::FieldDescriptor::CppType;

tl::unexpected<Error> refuse_value(const std::string& place, const std::string& what) {
  return fail_field(Code::kInvalidArgument, place, what, ErrorReason::JSON_INVALID);
}

// Checks one value of a field. `index` is the position in a repeated field, otherwise -1.
Status check_value(const pb::Message& message, const pb::FieldDescriptor& field, int index,
                   const std::string& place);

Status check_inside(const pb::Message& message, const std::string& before) {
  std::vector<const pb::FieldDescriptor*> fields;
  message.GetReflection()->ListFields(message, &fields);
  for (const pb::FieldDescriptor* field : fields) {
    const std::string place = before + field->json_name();
    if (!field->is_repeated()) {
      HP_RETURN_IF_ERROR(check_value(message, *field, -1, place));
      continue;
    }
    const int count = message.GetReflection()->FieldSize(message, field);
    for (int i = 0; i < count; ++i) {
      HP_RETURN_IF_ERROR(check_value(message, *field, i, fmt::format("{}[{}]", place, i)));
    }
  }
  return {};
}

Status check_value(const pb::Message& message, const pb::FieldDescriptor& field, int index,
                   const std::string& place) {
  const pb::Reflection& look = *message.GetReflection();
  const bool one = index < 0;
  switch (field.cpp_type()) {
    case Type::CPPTYPE_MESSAGE:
      return check_inside(
          one ? look.GetMessage(message, &field) : look.GetRepeatedMessage(message, &field, index),
          place + ".");
    case Type::CPPTYPE_DOUBLE:
    case Type::CPPTYPE_FLOAT: {
      const bool is_double = field.cpp_type() == Type::CPPTYPE_DOUBLE;
      const double value =
          is_double ? (one ? look.GetDouble(message, &field)
                           : look.GetRepeatedDouble(message, &field, index))
                    : static_cast<double>(one ? look.GetFloat(message, &field)
                                              : look.GetRepeatedFloat(message, &field, index));
      return std::isfinite(value) ? Status{} : refuse_value(place, "must be a finite number");
    }
    case Type::CPPTYPE_ENUM: {
      const int number = one ? look.GetEnumValue(message, &field)
                             : look.GetRepeatedEnumValue(message, &field, index);
      if (field.enum_type()->FindValueByNumber(number) != nullptr) return {};
      return refuse_value(place,
                          fmt::format("{} has no value {}", field.enum_type()->name(), number));
    }
    default:
      return {};
  }
}

}  // namespace

Status check_values(const pb::Message& message) { return check_inside(message, {}); }

Status read_json(std::string_view text, pb::Message& message, std::string_view what) {
  HP_RETURN_IF_ERROR(check_json(text, *message.GetDescriptor(), what));
  const pb::StringPiece whole(text.data(), text.size());
  const auto status = pb::util::JsonStringToMessage(whole, &message);
  if (!status.ok()) {
    const std::string words = status.message().ToString();
    return fail(Code::kInvalidArgument, fmt::format("{}: {}", what, plain(words)),
                ErrorReason::JSON_INVALID);
  }
  return check_values(message);
}

}  // namespace hydroprint::rest
