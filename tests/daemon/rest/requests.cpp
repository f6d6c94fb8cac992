#include "tests/daemon/rest/requests.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "daemon/rest/percent.h"

namespace hydroprint::rest {
namespace {

namespace pb = google::protobuf;
using Type = pb::FieldDescriptor::CppType;
using Random = std::mt19937;

std::size_t below(Random& random, std::size_t count) { return random() % count; }

std::string random_text(Random& random) {
  static const std::vector<std::string> kParts = {"a", "7",  " ", "/",  "%",    "%2F", "\"", "\\",
                                                  "&", "=",  "+", "?",  "#",    ":",   "\n", "\x01",
                                                  "é", "水", ".", "..", "\x7f", "😀",   "{",  "}"};
  std::string text;
  for (std::size_t i = below(random, 5); i > 0; --i) text += kParts[below(random, kParts.size())];
  return text;
}

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

template <class Number>
std::string decimal(Number number) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.17g", static_cast<double>(number));
  return text;
}

// Of the well-known types not everything that fits into their fields means something.
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

void draw(pb::Message& message, Random& random, int levels);

// Sets, or adds to, one field.
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

void draw(pb::Message& message, Random& random, int levels) {
  const pb::Descriptor& type = *message.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const pb::FieldDescriptor& field = *type.field(i);
    std::size_t times = below(random, field.is_repeated() ? 4 : 2);
    if (field.is_map()) times = std::min<std::size_t>(times, 1);  // the same key twice is not equal
    for (; times > 0; --times) draw_field(message, field, random, levels);
  }
}

// One value of a leaf field as a URL has it; of a repeated one that at `index`, else -1.
std::string text_of(const pb::Message& message, const pb::FieldDescriptor& field, int index) {
  const pb::Reflection& look = *message.GetReflection();
  const bool one = index < 0;
  if (field.cpp_type() == Type::CPPTYPE_DOUBLE) {
    return decimal(one ? look.GetDouble(message, &field)
                       : look.GetRepeatedDouble(message, &field, index));
  }
  if (field.cpp_type() == Type::CPPTYPE_FLOAT) {
    return decimal(one ? look.GetFloat(message, &field)
                       : look.GetRepeatedFloat(message, &field, index));
  }
  pb::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  std::string text;
  if (!pb::util::MessageToJsonString(message, &text, options).ok()) throw std::logic_error("JSON");
  nlohmann::json value = nlohmann::json::parse(text).at(field.json_name());
  if (!one) value = nlohmann::json(value.at(static_cast<std::size_t>(index)));
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string random_piece(Random& random, bool may_hold_slash) {
  std::string piece;
  while (piece.empty()) {
    piece = random_text(random);
    if (!may_hold_slash) std::erase(piece, '/');
  }
  return piece;
}

pb::Message& inside(pb::Message& message, const FieldPath& path) {
  pb::Message* at = &message;
  for (const pb::FieldDescriptor* field : path) {
    if (field != path.back()) at = at->GetReflection()->MutableMessage(at, field);
  }
  return *at;
}

// The segments that a variable stands for; its field is set to what they say.
std::vector<std::string> segments_of(const Route& route, std::size_t variable, pb::Message& message,
                                     Random& random) {
  const FieldPath& path = route.path_fields[variable];
  const pb::FieldDescriptor& field = *path.back();
  pb::Message& holder = inside(message, path);
  if (field.type() != pb::FieldDescriptor::TYPE_STRING) {
    draw_field(holder, field, random, 0);
    return {encode(text_of(holder, field, -1))};
  }
  const auto [name, begin, end] = route.path.variables[variable];
  std::vector<std::string> pieces;
  for (std::size_t i = begin; i < end; ++i) {
    const Segment& segment = route.path.segments[i];
    const bool is_rest = segment.kind == Segment::Kind::kRest;
    const bool is_single = end - begin == 1 && !is_rest;
    if (segment.kind == Segment::Kind::kLiteral) pieces.push_back(segment.literal);
    if (segment.kind == Segment::Kind::kOne) pieces.push_back(random_piece(random, is_single));
    for (std::size_t k = is_rest ? below(random, 4) : 0; k > 0; --k) {
      pieces.push_back(random_piece(random, false));
    }
  }
  std::string value;
  for (std::string& piece : pieces) {
    value += (value.empty() ? "" : "/") + piece;
    piece = encode(piece);
  }
  holder.GetReflection()->SetString(&holder, &field, value);
  return pieces;
}

std::string path_for(const Route& route, pb::Message& message, Random& random) {
  std::string path;
  for (std::size_t i = 0; i < route.path.segments.size(); ++i) {
    std::size_t variable = 0;
    while (variable < route.path.variables.size() && route.path.variables[variable].begin != i) {
      ++variable;
    }
    if (variable < route.path.variables.size()) {
      for (const auto& text : segments_of(route, variable, message, random)) path += "/" + text;
      i = route.path.variables[variable].end - 1;
    } else if (route.path.segments[i].kind == Segment::Kind::kLiteral) {
      path += "/" + encode(route.path.segments[i].literal);
    } else {
      path += "/" + encode(random_piece(random, true));
    }
  }
  return route.path.verb.empty() ? path : path + ":" + encode(route.path.verb);
}

std::string json_of(const pb::Message& message) {
  std::string text;
  if (!pb::util::MessageToJsonString(message, &text).ok()) throw std::logic_error("JSON");
  return text;
}

// Appends what a query can say of the message, and removes from it what it cannot.
void write_query(const Route& route, pb::Message& message, const FieldPath& before,
                 const std::string& prefix, std::string& query) {
  const pb::Reflection& look = *message.GetReflection();
  std::vector<const pb::FieldDescriptor*> fields;
  look.ListFields(message, &fields);
  for (const pb::FieldDescriptor* field : fields) {
    FieldPath path = before;
    path.push_back(field);
    const auto& bound = route.path_fields;
    if (std::find(bound.begin(), bound.end(), path) != bound.end()) continue;
    if (before.empty() && field == route.body_field) continue;
    // Either name will do.
    const std::string name = prefix + (query.size() % 2 == 0 ? field->name() : field->json_name());
    const bool is_object = field->message_type() != nullptr && !is_written_as_value(*field);
    if (is_object && field->is_repeated()) {
      look.ClearField(&message, field);
    } else if (is_object) {
      const std::size_t length = query.size();
      write_query(route, *look.MutableMessage(&message, field), path, name + ".", query);
      const auto leads = [&](const FieldPath& other) {
        return other.size() > path.size() && std::equal(path.begin(), path.end(), other.begin());
      };
      const bool has_bound = std::any_of(bound.begin(), bound.end(), leads);
      if (query.size() == length && !has_bound) look.ClearField(&message, field);
    } else {
      const int count = field->is_repeated() ? look.FieldSize(message, field) : 1;
      for (int i = 0; i < count; ++i) {
        const std::string text = text_of(message, *field, field->is_repeated() ? i : -1);
        query += (query.empty() ? "" : "&") + encode(name) + "=" + encode(text);
      }
    }
  }
}

}  // namespace

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
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

std::string some_path(const Route& route) {
  Random random(1);
  return path_for(route, *new_message(*route.method->input_type()), random);
}

Sent sent(const Route& route, pb::Message& message, Random& random) {
  Sent request{path_for(route, message, random), {}};
  if (route.body == Body::kAll) {
    const std::unique_ptr<pb::Message> rest(message.New());
    rest->CopyFrom(message);
    for (const FieldPath& path : route.path_fields) {
      pb::Message& holder = inside(*rest, path);
      holder.GetReflection()->ClearField(&holder, path.back());
    }
    request.body = json_of(*rest);
    return request;
  }
  const pb::Reflection& look = *message.GetReflection();
  if (route.body == Body::kField && look.HasField(message, route.body_field)) {
    request.body = json_of(look.GetMessage(message, route.body_field));
  }
  std::string query;
  write_query(route, message, {}, "", query);
  if (!query.empty()) request.target += "?" + query;
  return request;
}

}  // namespace hydroprint::rest
