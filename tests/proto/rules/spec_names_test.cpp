#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include "hydroprint/v1/field_rules.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/rules/field_rules.h"
#include "sim/base/immersions_file.h"
#include "sim/fit/parameters.h"
#include "sim/plan/fragments.h"
#include "sim/validate/validate.h"

namespace hydroprint::rules {
namespace {

TEST(SpecNames, ExperimentsAreThoseThatCanBeRun) {
  std::vector<std::string> names;
  for (const auto& kind : validate::kinds()) names.push_back(kind.name);
  EXPECT_EQ(choices(*v1::ValidateSpec::descriptor()->FindFieldByName("only")), names);
}

TEST(SpecNames, ParametersAreThoseThatCanBeFitted) {
  const auto names = choices(*v1::FitSpec::descriptor()->FindFieldByName("free"));
  for (const std::string& name : names) EXPECT_TRUE(fit::parse_parameters({name})) << name;
  EXPECT_EQ(fit::parse_parameters(names).value(), fit::parse_parameters({}).value())
      << "the names must be all parameters";
}

TEST(SpecNames, MostDipsOfAPlanAreAsManyAsCanBeDividedAndListed) {
  const auto& field = *v1::PlanSpec::descriptor()->FindFieldByName("immersions");
  EXPECT_EQ(rules_of(field)->max_items(), plan::kMaxDips);
  EXPECT_EQ(kMostDips, plan::kMaxDips);
}

}  // namespace
}  // namespace hydroprint::rules
