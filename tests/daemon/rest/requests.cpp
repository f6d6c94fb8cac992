#include "tests/daemon/rest/requests.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "daemon/rest/percent.h"

namespace hydroprint::rest {
namespace {

namespace pb = google::protobuf;
using Type = pb::FieldDescriptor::CppType;
using Random = std::mt19937;

template <class Number>
std::string decimal(Number number) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.17g", static_cast<double>(number));
  return text;
}

// One value of a leaf field as written in a URL. `index` is the position in a repeated field, and
// -1 for other fields.
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

// Draws the path segments of a variable, and sets its field in the message to match.
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
    for (std::size_t k = is_rest ? random() % 4 : 0; k > 0; --k) {
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

// Appends the fields that a query can express, and removes the others from the message.
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
    // Both the proto name and the JSON name must be accepted, so the request uses either.
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
