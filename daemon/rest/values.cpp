#include "daemon/rest/values.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <charconv>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "daemon/rest/json_text.h"
#include "daemon/rest/percent.h"

namespace hydroprint::rest {
namespace {

namespace pb = google::protobuf;
using Type = pb::FieldDescriptor::CppType;

// Parses the whole text as a number; nullopt if it is not a finite number in the range of the type.
template <class Number>
std::optional<Number> number_in(const std::string& text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stop != end || text.empty()) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(number)) return std::nullopt;
  }
  return number;
}

std::optional<bool> truth_in(const std::string& text) {
  if (text == "true") return true;
  if (text == "false") return false;
  return std::nullopt;
}

std::optional<int> value_in(const pb::EnumDescriptor& names, const std::string& text) {
  const pb::EnumValueDescriptor* value = names.FindValueByName(text);
  if (value != nullptr) return value->number();
  const auto number = number_in<int>(text);
  return number && names.FindValueByNumber(*number) != nullptr ? number : std::nullopt;
}

// Sets the field, or appends to a repeated field, with the setters for its type; false if there is
// no value.
template <class Value, class Set, class Add>
bool put(pb::Message& message, const pb::FieldDescriptor& field, const std::optional<Value>& value,
         Set set, Add add) {
  if (!value) return false;
  const pb::Reflection& reflection = *message.GetReflection();
  if (field.is_repeated()) {
    (reflection.*add)(&message, &field, *value);
  } else {
    (reflection.*set)(&message, &field, *value);
  }
  return true;
}

// Reads the types that need the JSON mapping: bytes, Timestamp, Duration, FieldMask.
bool put_by_json(pb::Message& message, const pb::FieldDescriptor& field, const std::string& text) {
  nlohmann::json value = text;
  if (field.is_repeated()) value = nlohmann::json::array({text});
  const std::unique_ptr<pb::Message> read(message.New());
  if (!read_json(nlohmann::json{{field.name(), value}}.dump(), *read)) return false;
  message.MergeFrom(*read);
  return true;
}

bool put_text(pb::Message& message, const pb::FieldDescriptor& field, const std::string& text) {
  using Look = pb::Reflection;
  switch (field.cpp_type()) {
    case Type::CPPTYPE_INT32:
      return put(message, field, number_in<std::int32_t>(text), &Look::SetInt32, &Look::AddInt32);
    case Type::CPPTYPE_UINT32:
      return put(message, field, number_in<std::uint32_t>(text), &Look::SetUInt32,
                 &Look::AddUInt32);
    case Type::CPPTYPE_INT64:
      return put(message, field, number_in<std::int64_t>(text), &Look::SetInt64, &Look::AddInt64);
    case Type::CPPTYPE_UINT64:
      return put(message, field, number_in<std::uint64_t>(text), &Look::SetUInt64,
                 &Look::AddUInt64);
    case Type::CPPTYPE_DOUBLE:
      return put(message, field, number_in<double>(text), &Look::SetDouble, &Look::AddDouble);
    case Type::CPPTYPE_FLOAT:
      return put(message, field, number_in<float>(text), &Look::SetFloat, &Look::AddFloat);
    case Type::CPPTYPE_BOOL:
      return put(message, field, truth_in(text), &Look::SetBool, &Look::AddBool);
    case Type::CPPTYPE_ENUM:
      return put(message, field, value_in(*field.enum_type(), text), &Look::SetEnumValue,
                 &Look::AddEnumValue);
    case Type::CPPTYPE_STRING:
      if (field.type() == pb::FieldDescriptor::TYPE_BYTES) {
        return put_by_json(message, field, text);
      }
      return put(message, field, std::optional<std::string>(text), &Look::SetString,
                 &Look::AddString);
    case Type::CPPTYPE_MESSAGE:
      break;
  }
  if (!is_wrapper(field)) return put_by_json(message, field, text);
  const Look& look = *message.GetReflection();
  pb::Message* inside = field.is_repeated() ? look.AddMessage(&message, &field)
                                            : look.MutableMessage(&message, &field);
  return put_text(*inside, *field.message_type()->field(0), text);
}

// Names the expected value, for the error message.
std::string expected(const pb::FieldDescriptor& field) {
  if (field.enum_type() != nullptr) return "a name or number of " + field.enum_type()->name();
  if (field.message_type() != nullptr) return "a " + field.message_type()->name();
  if (field.type() == pb::FieldDescriptor::TYPE_BYTES) return "base64";
  if (field.type() == pb::FieldDescriptor::TYPE_BOOL) return "\"true\" or \"false\"";
  return std::string("a valid number of type ") + field.type_name();
}

// Returns another member of the field's oneof that is already set; null if there is none.
const pb::FieldDescriptor* rival(const pb::Message& message, const pb::FieldDescriptor& field) {
  const pb::OneofDescriptor* oneof = field.real_containing_oneof();
  if (oneof == nullptr) return nullptr;
  const auto* set = message.GetReflection()->GetOneofFieldDescriptor(message, oneof);
  return set == &field ? nullptr : set;
}

}  // namespace

tl::unexpected<Error> bad_parameter(const std::string& field, const std::string& what) {
  return fail_field(Code::kInvalidArgument, field, what, ErrorReason::PARAMETER_INVALID);
}

Status set_from_text(pb::Message& message, const FieldPath& path, const std::string& text) {
  const pb::FieldDescriptor& last = *path.back();
  const std::string name = path_text(path);
  if (last.is_map() || (last.message_type() != nullptr && !is_written_as_value(last))) {
    return bad_parameter(
        name, fmt::format("is a {} and cannot be in a URL", last.is_map() ? "map" : "message"));
  }
  pb::Message* inside = &message;
  for (const pb::FieldDescriptor* field : path) {
    if (const auto* other = rival(*inside, *field)) {
      return bad_parameter(
          name, fmt::format("cannot be combined with {}; give only one of them", other->name()));
    }
    if (field != &last) inside = inside->GetReflection()->MutableMessage(inside, field);
  }
  if (put_text(*inside, last, text)) return {};
  return bad_parameter(name, fmt::format("\"{}\" is not {}", plain(text), expected(last)));
}

}  // namespace hydroprint::rest
