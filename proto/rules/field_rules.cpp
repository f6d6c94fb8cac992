#include "proto/rules/field_rules.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "hydroprint/v1/field_rules.pb.h"
#include "proto/rules/comments.h"

namespace hydroprint::rules {
namespace {

namespace pb = google::protobuf;

// Returns the shortest decimal notation without an exponent.
std::string number_text(double value) {
  std::array<char, 400> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed);
  return {buffer.data(), end.ptr};
}

// Returns a duration in the largest unit that divides it: "8 hours".
std::string duration_text(double seconds) {
  struct Unit {
    double seconds;
    const char* name;
  };
  constexpr std::array kUnits = {Unit{86400, "day"}, Unit{3600, "hour"}, Unit{60, "minute"}};
  for (const Unit& unit : kUnits) {
    if (seconds == 0 || std::fmod(seconds, unit.seconds) != 0) continue;
    const double count = seconds / unit.seconds;
    return number_text(count) + " " + unit.name + (count == 1 ? "" : "s");
  }
  return number_text(seconds) + (seconds == 1 ? " second" : " seconds");
}

bool is_duration(const pb::FieldDescriptor& field) {
  return field.message_type() != nullptr &&
         field.message_type()->full_name() == "google.protobuf.Duration";
}

// Returns a value in the notation for users: "sheet" for "MODEL_SHEET". The name of the zero value
// ("MODEL_UNSPECIFIED") determines the prefix to remove.
std::string choice_text(const pb::EnumValueDescriptor& value) {
  constexpr std::string_view kZero = "UNSPECIFIED";
  const std::string& zero = value.type()->value(0)->name();
  const std::string prefix =
      zero.ends_with(kZero) ? zero.substr(0, zero.size() - kZero.size()) : std::string();
  std::string text = value.name();
  if (text.starts_with(prefix)) text.erase(0, prefix.size());
  for (char& c : text) {
    c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return text;
}

// Returns the field that declares the rules: `field` itself, or the field that its `like` names.
const pb::FieldDescriptor& declared_by(const pb::FieldDescriptor& field) {
  const std::string& like = field.options().GetExtension(v1::rules).like();
  if (like.empty()) return field;
  const auto* other = field.file()->pool()->FindFieldByName(field.file()->package() + "." + like);
  return other == nullptr ? field : *other;
}

std::string joined(const std::string& first, const std::string& second) {
  return first.empty() || second.empty() ? first + second : first + "; " + second;
}

// Returns the range with its unit (or only the unit) and the choices.
std::string limits(const pb::FieldDescriptor& field) {
  std::string text = range_text(field);
  const v1::FieldRules* const rules = rules_of(field);
  if (text.empty() && rules != nullptr && !rules->unit().empty()) text = "in " + rules->unit();
  std::string names;
  for (const std::string& name : choices(field)) names += (names.empty() ? "" : ", ") + name;
  return joined(text, names);
}

}  // namespace

const v1::FieldRules* rules_of(const pb::FieldDescriptor& field) {
  const pb::FieldDescriptor& declared = declared_by(field);
  if (!declared.options().HasExtension(v1::rules)) return nullptr;
  return &declared.options().GetExtension(v1::rules);
}

bool is_in_range(const v1::FieldRules& rules, double value) {
  const bool is_enough =
      !rules.has_min() || (rules.above_min() ? value > rules.min() : value >= rules.min());
  return is_enough && (!rules.has_max() || value <= rules.max());
}

std::string range_text(const pb::FieldDescriptor& field) {
  const v1::FieldRules* const rules = rules_of(field);
  if (rules == nullptr || (!rules->has_min() && !rules->has_max())) return {};
  const auto number = is_duration(field) ? duration_text : number_text;
  const std::string unit = rules->unit().empty() || is_duration(field) ? "" : " " + rules->unit();
  const std::string min = number(rules->min()), max = number(rules->max());
  if (!rules->has_max()) return (rules->above_min() ? "above " : "at least ") + min + unit;
  if (!rules->has_min()) return "at most " + max + unit;
  return (rules->above_min() ? "above " + min + " and at most " : "from " + min + " to ") + max +
         unit;
}

std::vector<std::string> choices(const pb::FieldDescriptor& field) {
  if (field.enum_type() != nullptr) {
    std::vector<std::string> out;
    for (int i = 1; i < field.enum_type()->value_count(); ++i) {
      out.push_back(choice_text(*field.enum_type()->value(i)));
    }
    return out;
  }
  const v1::FieldRules* const rules = rules_of(field);
  if (rules == nullptr) return {};
  return {rules->values().begin(), rules->values().end()};
}

std::string default_text(const pb::FieldDescriptor& field) {
  const v1::FieldRules* const rules = rules_of(field);
  if (rules == nullptr) return {};
  if (field.enum_type() != nullptr) {
    const auto* value = field.enum_type()->FindValueByName(rules->default_value());
    return value == nullptr ? std::string() : choice_text(*value);
  }
  return rules->default_value();
}

std::string help_text(const pb::FieldDescriptor& field) {
  const std::string value = default_text(field);
  return joined(limits(field), value.empty() ? value : "default " + value);
}

std::string flag_help(const pb::FieldDescriptor& field) {
  const v1::FieldRules* const rules = rules_of(field);
  std::string comment = comment_on(field.full_name());
  if (comment.starts_with("See ")) comment = comment_on(declared_by(field).full_name());
  std::string text = rules == nullptr ? std::string() : rules->flag_help();
  const std::string value = text.empty() ? stated_default(comment) : std::string();
  if (text.empty()) text = first_sentence(comment);
  const std::string details =
      value.empty() ? help_text(field) : joined(limits(field), "default: " + value);
  return details.empty() ? text : text + " (" + details + ")";
}

std::string flag_of(const pb::FieldDescriptor& field) {
  const v1::FieldRules* const rules = rules_of(field);
  if (rules != nullptr && !rules->flag().empty()) return rules->flag();
  std::string flag = field.name();
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

}  // namespace hydroprint::rules
