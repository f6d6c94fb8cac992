#include "proto/rules/check.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/duration.pb.h>
#include <google/protobuf/message.h>
#include <google/protobuf/reflection.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "hydroprint/v1/field_rules.pb.h"
#include "proto/rules/field_rules.h"

namespace hydroprint::rules {
namespace {

namespace pb = google::protobuf;
using Type = pb::FieldDescriptor::CppType;

constexpr double kUnitLengthTolerance = 1e-3;
constexpr std::size_t kLongestQuote = 40;

bool is_control(char c) { return static_cast<unsigned char>(c) < ' ' || c == 0x7f; }

// Quotes a value that a client sent, shortened and without control characters.
std::string quoted(const std::string& text) {
  std::string out = text.substr(0, kLongestQuote);
  std::replace_if(out.begin(), out.end(), is_control, '?');
  return "\"" + out + (text.size() > kLongestQuote ? "...\"" : "\"");
}

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    out += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
  }
  return out;
}

std::string number_problem(const pb::FieldDescriptor& field, const v1::FieldRules& rules,
                           double value) {
  if (std::isfinite(value) && is_in_range(rules, value)) return {};
  const std::string range = range_text(field);
  return "must be " + (range.empty() ? "a finite number" : range);
}

std::string text_problem(const pb::FieldDescriptor& field, const v1::FieldRules& rules,
                         const std::string& text, const FormatChecks& formats) {
  if (rules.max_bytes() > 0) {
    if (text.size() > static_cast<std::size_t>(rules.max_bytes())) {
      return "is longer than " + std::to_string(rules.max_bytes()) + " bytes; shorten it";
    }
    const bool is_text = field.type() != pb::FieldDescriptor::TYPE_BYTES;
    if (is_text && std::any_of(text.begin(), text.end(), is_control)) {
      return "has control characters; leave them out";
    }
  }
  if (rules.values_size() > 0 &&
      std::find(rules.values().begin(), rules.values().end(), text) == rules.values().end()) {
    return "must be " + listed(choices(field)) + ", not " + quoted(text);
  }
  const auto format = formats.find(rules.format());
  return format == formats.end() ? std::string() : format->second(text);
}

std::string duration_problem(const pb::FieldDescriptor& field, const v1::FieldRules& rules,
                             const pb::Message& message) {
  pb::Duration duration;
  duration.CopyFrom(message);
  return number_problem(
      field, rules,
      static_cast<double>(duration.seconds()) + static_cast<double>(duration.nanos()) * 1e-9);
}

int count_of(const pb::Message& message, const pb::FieldDescriptor& field) {
  const pb::Reflection& reflection = *message.GetReflection();
  return field.is_repeated() ? reflection.FieldSize(message, &field)
                             : reflection.HasField(message, &field);
}

bool has(const pb::Message& message, const std::string& name) {
  const pb::FieldDescriptor* const field = message.GetDescriptor()->FindFieldByName(name);
  return field != nullptr && count_of(message, *field) > 0;
}

// Returns the names of the fields that are replaced, each with the name of the set field that
// replaces it.
std::map<std::string, std::string> replaced_fields(const pb::Message& message) {
  std::map<std::string, std::string> out;
  std::vector<const pb::FieldDescriptor*> fields;
  message.GetReflection()->ListFields(message, &fields);
  for (const pb::FieldDescriptor* field : fields) {
    const v1::FieldRules* const rules = rules_of(*field);
    if (rules == nullptr) continue;
    for (const std::string& name : rules->replaces()) out[name] = field->name();
  }
  return out;
}

class Checker {
 public:
  explicit Checker(const FormatChecks& formats) : formats_(formats) {}

  void check_message(const pb::Message& message, const std::string& path) {
    const pb::Descriptor& type = *message.GetDescriptor();
    const auto replaced = replaced_fields(message);
    for (int i = 0; i < type.field_count(); ++i) {
      const pb::FieldDescriptor& field = *type.field(i);
      const std::string place = (path.empty() ? "" : path + ".") + field.name();
      const auto by = replaced.find(field.name());
      if (by != replaced.end() && count_of(message, field) > 0) {
        violations_.push_back({place, "is taken from " + by->second + "; leave one of the two out",
                               ErrorReason::SPEC_INVALID});
      } else {
        check_field(message, field, place);
      }
    }
  }

  [[nodiscard]] std::vector<Violation> take_violations() { return std::move(violations_); }

 private:
  void check_field(const pb::Message& message, const pb::FieldDescriptor& field,
                   const std::string& path) {
    const v1::FieldRules* const found = rules_of(field);
    const v1::FieldRules& rules = found == nullptr ? v1::FieldRules::default_instance() : *found;
    if (rules.read_only()) return;
    const int count = count_of(message, field);
    if (count == 0) {
      if (rules.required() && !has(message, rules.unless())) add(path, rules, "is missing");
      return;
    }
    if (!field.is_repeated()) {
      check_value(message, field, rules, -1, path);
    } else if (std::string problem = list_problem(message, field, rules, count); !problem.empty()) {
      add(path, rules, problem);
    } else {
      check_values(message, field, rules, count, path);
    }
  }

  void check_values(const pb::Message& message, const pb::FieldDescriptor& field,
                    const v1::FieldRules& rules, int count, const std::string& path) {
    const std::size_t before = violations_.size();
    for (int i = 0; i < count; ++i) {
      const bool has_places = field.message_type() != nullptr && !field.is_map();
      // One violation is enough for a list of plain values.
      if (!has_places && violations_.size() > before) return;
      check_value(message, field, rules, i,
                  has_places ? path + "[" + std::to_string(i) + "]" : path);
    }
  }

  // `at` is the index in a repeated field; -1 for a field that is not repeated.
  void check_value(const pb::Message& message, const pb::FieldDescriptor& field,
                   const v1::FieldRules& rules, int at, const std::string& path) {
    if (field.is_map()) {
      check_map_entry(message, field, rules, at, path);
    } else if (field.cpp_type() == Type::CPPTYPE_MESSAGE) {
      const pb::Reflection& reflection = *message.GetReflection();
      const pb::Message& value = at < 0 ? reflection.GetMessage(message, &field)
                                        : reflection.GetRepeatedMessage(message, &field, at);
      if (field.message_type() == pb::Duration::descriptor()) {
        add(path, rules, duration_problem(field, rules, value));
      } else {
        check_message(value, path);
      }
    } else {
      add(path, rules, scalar_problem(message, field, rules, at));
    }
  }

  // The rules of a map apply to its keys and to its values.
  void check_map_entry(const pb::Message& message, const pb::FieldDescriptor& field,
                       const v1::FieldRules& rules, int at, const std::string& path) {
    const pb::Message& entry = message.GetReflection()->GetRepeatedMessage(message, &field, at);
    std::string problem = scalar_problem(entry, *field.message_type()->map_key(), rules, -1);
    if (problem.empty() && field.message_type()->map_value()->message_type() == nullptr) {
      problem = scalar_problem(entry, *field.message_type()->map_value(), rules, -1);
    }
    add(path, rules, problem);
  }

  [[nodiscard]] std::string scalar_problem(const pb::Message& message,
                                           const pb::FieldDescriptor& field,
                                           const v1::FieldRules& rules, int at) const {
    const pb::Reflection& r = *message.GetReflection();
    switch (field.cpp_type()) {
      case Type::CPPTYPE_DOUBLE:
        return number_problem(
            field, rules,
            at < 0 ? r.GetDouble(message, &field) : r.GetRepeatedDouble(message, &field, at));
      case Type::CPPTYPE_FLOAT:
        return number_problem(
            field, rules,
            at < 0 ? r.GetFloat(message, &field) : r.GetRepeatedFloat(message, &field, at));
      case Type::CPPTYPE_INT32:
        return number_problem(
            field, rules,
            at < 0 ? r.GetInt32(message, &field) : r.GetRepeatedInt32(message, &field, at));
      case Type::CPPTYPE_INT64:
        return number_problem(
            field, rules,
            static_cast<double>(at < 0 ? r.GetInt64(message, &field)
                                       : r.GetRepeatedInt64(message, &field, at)));
      case Type::CPPTYPE_STRING:
        return text_problem(
            field, rules,
            at < 0 ? r.GetString(message, &field) : r.GetRepeatedString(message, &field, at),
            formats_);
      case Type::CPPTYPE_ENUM:
        return enum_problem(field, at < 0 ? r.GetEnumValue(message, &field)
                                          : r.GetRepeatedEnumValue(message, &field, at));
      default:
        return {};
    }
  }

  static std::string enum_problem(const pb::FieldDescriptor& field, int number) {
    if (field.enum_type()->FindValueByNumber(number) != nullptr) return {};
    std::vector<std::string> names;
    for (int i = 1; i < field.enum_type()->value_count(); ++i) {
      names.push_back(field.enum_type()->value(i)->name());
    }
    return "must be " + listed(names);
  }

  static std::string list_problem(const pb::Message& message, const pb::FieldDescriptor& field,
                                  const v1::FieldRules& rules, int count) {
    if (rules.max_items() > 0 && rules.min_items() == rules.max_items() &&
        count != rules.max_items()) {
      return "must have exactly " + std::to_string(rules.max_items()) + " values";
    }
    if (count < rules.min_items()) {
      return "must have at least " + std::to_string(rules.min_items()) + " values";
    }
    if (rules.max_items() > 0 && count > rules.max_items()) {
      return "must have at most " + std::to_string(rules.max_items()) + " values";
    }
    if (!rules.unit_length()) return {};
    const auto values = message.GetReflection()->GetRepeatedFieldRef<double>(message, &field);
    double square = 0;
    for (const double value : values) square += value * value;
    // The comparison is false for NaN.
    return std::abs(std::sqrt(square) - 1) <= kUnitLengthTolerance ? "" : "must have length 1";
  }

  void add(const std::string& path, const v1::FieldRules& rules, const std::string& problem) {
    if (problem.empty()) return;
    const bool has_reason = rules.reason() != v1::ERROR_REASON_UNSPECIFIED;
    violations_.push_back(
        {path, problem,
         has_reason ? static_cast<ErrorReason>(rules.reason()) : ErrorReason::SPEC_INVALID});
  }

  const FormatChecks& formats_;
  std::vector<Violation> violations_;
};

}  // namespace

std::vector<Violation> check(const pb::Message& message, const FormatChecks& formats,
                             const std::string& path) {
  Checker checker(formats);
  checker.check_message(message, path);
  return checker.take_violations();
}

}  // namespace hydroprint::rules
