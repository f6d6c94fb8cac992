#include "tests/daemon/rest/random_message.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "daemon/rest/routes.h"
#include "proto/rules/field_rules.h"

namespace hydroprint::rest {
namespace {

namespace pb = google::protobuf;
using Type = pb::FieldDescriptor::CppType;
using Random = std::mt19937;

std::size_t below(Random& random, std::size_t count) { return random() % count; }

template <class Number>
Number random_number(Random& random) {
  using Limits = std::numeric_limits<Number>;
  const Number small = static_cast<Number>(static_cast<int>(below(random, 100)));
  const Number some[] = {Number{0},
                         Number{1},
                         Limits::max(),
                         Limits::lowest(),
                         Limits::min(),
                         small,
                         static_cast<Number>(Limits::max() / 3)};
  return some[below(random, std::size(some))];
}

// Draws a valid value: not every value of the fields of a well-known type is valid.
void draw_well_known(pb::Message& message, Random& random) {
  const pb::Descriptor& type = *message.GetDescriptor();
  const pb::Reflection& look = *message.GetReflection();
  if (type.name() == "FieldMask") {
    look.AddString(&message, type.FindFieldByName("paths"), "inner.some_text");
    look.AddString(&message, type.FindFieldByName("paths"), "colour");
    return;
  }
  const bool is_span = type.name() == "Duration";
  const std::int64_t seconds[] = {0, 1, 1700000000, 253402300799, is_span ? -5 : -62135596800};
  const std::int64_t second = seconds[below(random, std::size(seconds))];
  const int nanos[] = {0, 1, 500000000, 999999999};
  const int nano = nanos[below(random, std::size(nanos))];
  look.SetInt64(&message, type.FindFieldByName("seconds"), second);
  look.SetInt32(&message, type.FindFieldByName("nanos"), is_span && second < 0 ? -nano : nano);
}

bool is_wrapper_type(const pb::Descriptor& type) {
  return type.name().size() > 5 && type.name().substr(type.name().size() - 5) == "Value";
}

void draw(pb::Message& message, Random& random, int levels) {
  const pb::Descriptor& type = *message.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const pb::FieldDescriptor& field = *type.field(i);
    std::size_t times = below(random, field.is_repeated() ? 4 : 2);
    // At most one entry in a map, because a repeated key would not survive a round trip.
    if (field.is_map()) times = std::min<std::size_t>(times, 1);
    for (; times > 0; --times) draw_field(message, field, random, levels);
  }
}

}  // namespace

std::string random_text(Random& random) {
  static const std::vector<std::string> kParts = {"a", "7",  " ", "/",  "%",    "%2F", "\"", "\\",
                                                  "&", "=",  "+", "?",  "#",    ":",   "\n", "\x01",
                                                  "é", "水", ".", "..", "\x7f", "😀",   "{",  "}"};
  std::string text;
  for (std::size_t i = below(random, 5); i > 0; --i) text += kParts[below(random, kParts.size())];
  return text;
}

void draw_field(pb::Message& message, const pb::FieldDescriptor& field, Random& random,
                int levels) {
  const pb::Reflection& look = *message.GetReflection();
  const bool many = field.is_repeated();
  const auto put = [&](auto set, auto add, auto value) {
    many ? (look.*add)(&message, &field, value) : (look.*set)(&message, &field, value);
  };
  using Look = pb::Reflection;
  switch (field.cpp_type()) {
    case Type::CPPTYPE_INT32:
      return put(&Look::SetInt32, &Look::AddInt32, random_number<std::int32_t>(random));
    case Type::CPPTYPE_UINT32:
      return put(&Look::SetUInt32, &Look::AddUInt32, random_number<std::uint32_t>(random));
    case Type::CPPTYPE_INT64:
      return put(&Look::SetInt64, &Look::AddInt64, random_number<std::int64_t>(random));
    case Type::CPPTYPE_UINT64:
      return put(&Look::SetUInt64, &Look::AddUInt64, random_number<std::uint64_t>(random));
    case Type::CPPTYPE_DOUBLE:
      return put(&Look::SetDouble, &Look::AddDouble, random_number<double>(random));
    case Type::CPPTYPE_FLOAT:
      return put(&Look::SetFloat, &Look::AddFloat, random_number<float>(random));
    case Type::CPPTYPE_BOOL:
      return put(&Look::SetBool, &Look::AddBool, below(random, 2) == 1);
    case Type::CPPTYPE_ENUM: {
      const int count = field.enum_type()->value_count();
      const int at = static_cast<int>(below(random, static_cast<std::size_t>(count)));
      return put(&Look::SetEnumValue, &Look::AddEnumValue, field.enum_type()->value(at)->number());
    }
    case Type::CPPTYPE_STRING: {
      std::string text = random_text(random);
      // The schema lists the allowed values of some fields. All other rules are left to the
      // services.
      if (const auto values = rules::choices(field); !values.empty()) {
        text = values[below(random, values.size())];
      }
      if (field.type() == pb::FieldDescriptor::TYPE_BYTES) text += std::string("\0\xff\xc0", 3);
      return put(&Look::SetString, &Look::AddString, text);
    }
    case Type::CPPTYPE_MESSAGE:
      break;
  }
  if (levels == 0 && !is_written_as_value(field)) return;
  pb::Message* inside =
      many ? look.AddMessage(&message, &field) : look.MutableMessage(&message, &field);
  if (is_written_as_value(field) && !is_wrapper_type(*field.message_type())) {
    return draw_well_known(*inside, random);
  }
  draw(*inside, random, levels - 1);
}

std::unique_ptr<pb::Message> new_message(const pb::Descriptor& type) {
  return std::unique_ptr<pb::Message>(
      pb::MessageFactory::generated_factory()->GetPrototype(&type)->New());
}

std::unique_ptr<pb::Message> random_message(const pb::Descriptor& type, Random& random,
                                            int levels) {
  auto message = new_message(type);
  draw(*message, random, levels);
  return message;
}

}  // namespace hydroprint::rest
