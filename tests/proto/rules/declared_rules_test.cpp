// Tests of the rules that the .proto files declare.
#include <google/protobuf/descriptor.h>
#include <google/protobuf/dynamic_message.h>
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "hydroprint/v1/field_rules.pb.h"
#include "hydroprint/v1/job_service.pb.h"
#include "proto/rules/check.h"
#include "proto/rules/field_rules.h"

namespace hydroprint::rules {
namespace {

namespace pb = google::protobuf;
using Type = pb::FieldDescriptor::CppType;
using EachField = std::function<void(const pb::FieldDescriptor&)>;

void visit_message(const pb::Descriptor& message, const EachField& visit,
                   std::set<const pb::Descriptor*>& seen) {
  if (!seen.insert(&message).second) return;
  for (int i = 0; i < message.field_count(); ++i) {
    visit(*message.field(i));
    if (message.field(i)->message_type() != nullptr) {
      visit_message(*message.field(i)->message_type(), visit, seen);
    }
  }
}

// Visits the fields of all specs and of the messages that they contain.
void visit_spec_fields(const EachField& visit) {
  std::set<const pb::Descriptor*> seen;
  const pb::OneofDescriptor& specs = *v1::Job::descriptor()->FindOneofByName("spec");
  for (int i = 0; i < specs.field_count(); ++i) {
    visit_message(*specs.field(i)->message_type(), visit, seen);
  }
  ASSERT_GT(seen.size(), 11U);
}

// Visits the fields of all requests and responses.
void visit_all_fields(const EachField& visit) {
  std::set<const pb::Descriptor*> seen;
  for (const char* name : {"ArtifactService", "AssetService", "CalibrationService", "CameraService",
                           "EventService", "JobService", "LeaseService", "PeopleService",
                           "PreviewService", "QueueService", "RigService"}) {
    const auto* service = pb::DescriptorPool::generated_pool()->FindServiceByName(
        std::string("hydroprint.v1.") + name);
    ASSERT_NE(service, nullptr) << name;
    for (int i = 0; i < service->method_count(); ++i) {
      visit_message(*service->method(i)->input_type(), visit, seen);
      visit_message(*service->method(i)->output_type(), visit, seen);
    }
  }
}

bool is_number(const pb::FieldDescriptor& field) {
  const Type type = field.cpp_type();
  return type == Type::CPPTYPE_DOUBLE || type == Type::CPPTYPE_FLOAT ||
         type == Type::CPPTYPE_INT32 || type == Type::CPPTYPE_INT64;
}

std::optional<double> number_in(const std::string& text) {
  double value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc() || end.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

TEST(DeclaredRules, ReferencesLeadToRulesAndSayNothingElse) {
  visit_all_fields([](const pb::FieldDescriptor& field) {
    if (!field.options().HasExtension(v1::rules)) return;
    v1::FieldRules stated = field.options().GetExtension(v1::rules);
    if (stated.like().empty()) return;
    const v1::FieldRules* const found = rules_of(field);
    ASSERT_NE(found, nullptr) << field.full_name() << " like " << stated.like();
    EXPECT_TRUE(found->like().empty())
        << field.full_name() << ": `like` refers to a field that has `like` itself";
    EXPECT_GT(found->ByteSizeLong(), 0U)
        << field.full_name() << ": `like` refers to a field without rules";
    stated.clear_like();
    EXPECT_EQ(stated.ByteSizeLong(), 0U) << field.full_name() << ": has other rules besides `like`";
  });
}

TEST(DeclaredRules, FieldsThatRefuseOrReplaceEachOtherAreInOneMessage) {
  visit_all_fields([](const pb::FieldDescriptor& field) {
    const v1::FieldRules& stated = field.options().GetExtension(v1::rules);
    std::vector<std::string> names(stated.replaces().begin(), stated.replaces().end());
    if (!stated.unless().empty()) names.push_back(stated.unless());
    for (const std::string& name : names) {
      EXPECT_NE(field.containing_type()->FindFieldByName(name), nullptr)
          << field.full_name() << ": " << name;
    }
  });
}

TEST(DeclaredRules, FitTheTypesOfTheirFields) {
  visit_all_fields([](const pb::FieldDescriptor& field) {
    const v1::FieldRules* const rules = rules_of(field);
    if (rules == nullptr) return;
    const bool is_duration = field.message_type() != nullptr &&
                             field.message_type()->full_name() == "google.protobuf.Duration";
    const bool is_text = field.cpp_type() == Type::CPPTYPE_STRING || field.is_map();
    SCOPED_TRACE(field.full_name());
    EXPECT_TRUE(is_number(field) || is_duration || !(rules->has_min() || rules->has_max()));
    EXPECT_TRUE(!rules->has_min() || !rules->has_max() || rules->min() < rules->max());
    EXPECT_TRUE(rules->has_min() || !rules->above_min());
    EXPECT_TRUE(is_text || (rules->max_bytes() == 0 && rules->values_size() == 0));
    EXPECT_TRUE(is_text || rules->format().empty());
    EXPECT_TRUE(field.is_repeated() || (rules->min_items() == 0 && rules->max_items() == 0));
    EXPECT_LE(rules->min_items(), rules->max_items());
    EXPECT_TRUE(field.cpp_type() == Type::CPPTYPE_DOUBLE || !rules->unit_length());
    const auto value = number_in(rules->default_value());
    if (is_number(field) && value) {
      EXPECT_TRUE(!rules->has_min() || *value >= rules->min());
      EXPECT_TRUE(!rules->has_max() || *value <= rules->max());
    }
    if (field.enum_type() != nullptr && !rules->default_value().empty()) {
      EXPECT_NE(field.enum_type()->FindValueByName(rules->default_value()), nullptr);
    }
  });
}

TEST(DeclaredRules, EveryNumberOfASpecHasARange) {
  visit_spec_fields([](const pb::FieldDescriptor& field) {
    if (!is_number(field) || field.is_repeated()) return;
    const v1::FieldRules* const rules = rules_of(field);
    ASSERT_NE(rules, nullptr) << field.full_name();
    EXPECT_TRUE(rules->has_min() && rules->has_max()) << field.full_name();
  });
}

TEST(DeclaredRules, UnitsAreThoseOfTheFieldsNames) {
  const std::map<std::string, std::string> units = {
      {"_mm", "mm"},    {"_mm_per_s", "mm/s"},    {"_s", "s"},
      {"_mm2", "mm^2"}, {"_ml_per_m2", "ml/m^2"}, {"_c", "degrees Celsius"},
      {"_hz", "Hz"}};
  int checked = 0;
  visit_spec_fields([&](const pb::FieldDescriptor& field) {
    std::string ending;
    for (const auto& [name, unit] : units) {
      if (is_number(field) && field.name().ends_with(name) && name.size() > ending.size()) {
        ending = name;
      }
    }
    if (ending.empty()) return;
    const v1::FieldRules* const rules = rules_of(field);
    ASSERT_NE(rules, nullptr) << field.full_name();
    EXPECT_EQ(rules->unit(), units.at(ending)) << field.full_name();
    ++checked;
  });
  EXPECT_GT(checked, 15);
}

TEST(DeclaredRules, EveryTextOfASpecIsBounded) {
  visit_spec_fields([](const pb::FieldDescriptor& field) {
    if (field.cpp_type() != Type::CPPTYPE_STRING) return;
    const bool is_resource_name = field.name().ends_with("_job") || field.name() == "asset" ||
                                  field.name() == "capture_jobs" ||
                                  field.name().ends_with("calibration");
    if (is_resource_name) return;  // parsed as a resource name, so it needs no bound
    const v1::FieldRules* const rules = rules_of(field);
    ASSERT_NE(rules, nullptr) << field.full_name();
    EXPECT_TRUE(rules->max_bytes() > 0 || rules->values_size() > 0) << field.full_name();
  });
}

// A message with only this field set.
class OneField {
 public:
  explicit OneField(const pb::FieldDescriptor& field)
      : field_(field),
        message_(
            pb::MessageFactory::generated_factory()->GetPrototype(field.containing_type())->New()) {
  }

  [[nodiscard]] bool is_accepted(double value) {
    const pb::Reflection& reflection = *message_->GetReflection();
    if (field_.cpp_type() == Type::CPPTYPE_DOUBLE) {
      reflection.SetDouble(message_.get(), &field_, value);
    } else {
      reflection.SetInt32(message_.get(), &field_, static_cast<std::int32_t>(value));
    }
    for (const Violation& violation : check(*message_)) {
      if (violation.field == field_.name()) return false;
    }
    return true;
  }

 private:
  const pb::FieldDescriptor& field_;
  std::unique_ptr<pb::Message> message_;
};

TEST(DeclaredRules, EveryNumberOfASpecIsHeldToItsRange) {
  int checked = 0;
  visit_spec_fields([&](const pb::FieldDescriptor& field) {
    if (!is_number(field) || field.is_repeated()) return;
    SCOPED_TRACE(field.full_name());
    const v1::FieldRules& rules = *rules_of(field);
    OneField one(field);
    EXPECT_TRUE(one.is_accepted(rules.max()));
    EXPECT_EQ(one.is_accepted(rules.min()), !rules.above_min());
    ++checked;
    if (field.cpp_type() != Type::CPPTYPE_DOUBLE) {
      EXPECT_FALSE(one.is_accepted(rules.max() + 1));
      EXPECT_FALSE(one.is_accepted(rules.min() - 1));
      return;
    }
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(one.is_accepted(std::nextafter(rules.max(), kInfinity)));
    EXPECT_FALSE(one.is_accepted(std::nextafter(rules.min(), -kInfinity)));
    EXPECT_TRUE(one.is_accepted(std::nextafter(rules.min(), kInfinity)));
    for (const double bad : {std::nan(""), kInfinity, -kInfinity}) {
      EXPECT_FALSE(one.is_accepted(bad)) << bad;
    }
  });
  EXPECT_GT(checked, 25);
}

}  // namespace
}  // namespace hydroprint::rules
