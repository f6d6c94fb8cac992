#include "proto/rules/field_rules.h"

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include "hydroprint/v1/field_rules.pb.h"
#include "hydroprint/v1/lease_service.pb.h"
#include "hydroprint/v1/people_service.pb.h"
#include "hydroprint/v1/rig_service.pb.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::rules {
namespace {

using Names = std::vector<std::string>;

template <class Message>
const google::protobuf::FieldDescriptor& field(const char* name) {
  return *Message::descriptor()->FindFieldByName(name);
}

TEST(FieldRules, AFieldThatIsLikeAnotherHasItsRules) {
  const v1::FieldRules* rules = rules_of(field<v1::PredictSpec>("dpi"));
  ASSERT_NE(rules, nullptr);
  EXPECT_EQ(rules, rules_of(field<v1::SimulateSpec>("dpi")));
  EXPECT_EQ(rules_of(field<v1::SimulateSpec>("texture")), nullptr);
}

TEST(FieldRules, RangesReadAsSentences) {
  EXPECT_EQ(range_text(field<v1::SimulateSpec>("dpi")), "from 20 to 2400 dots per inch");
  EXPECT_EQ(range_text(field<v1::SimulateSpec>("ink_passes")), "from 0 to 10");
  EXPECT_EQ(range_text(field<v1::DipSpec>("film_area_mm2")), "above 0 and at most 10000000 mm^2");
  EXPECT_EQ(range_text(field<v1::ListUsersRequest>("page_size")), "at least 0");
  EXPECT_EQ(range_text(field<v1::AcquireLeaseRequest>("ttl")), "from 1 second to 8 hours");
  EXPECT_EQ(range_text(field<v1::CreateApiKeyRequest>("ttl")), "from 1 minute to 3660 days");
  EXPECT_EQ(range_text(field<v1::SimulateSpec>("film")), "");
}

TEST(FieldRules, ChoicesAreThoseOfTheCommandLine) {
  EXPECT_EQ(choices(field<v1::SimulateSpec>("model")), (Names{"sheet", "stokes"}));
  EXPECT_EQ(choices(field<v1::SimulateSpec>("artifacts")), (Names{"all", "map"}));
  EXPECT_EQ(choices(field<v1::PrintImageSpec>("formats")), (Names{"pdf", "png", "tiff"}));
  EXPECT_EQ(choices(field<v1::SimulateSpec>("film")), Names());
}

TEST(FieldRules, DefaultsAreThoseOfTheCommandLine) {
  EXPECT_EQ(default_text(field<v1::SimulateSpec>("dpi")), "300");
  EXPECT_EQ(default_text(field<v1::SimulateSpec>("depth_mm")), "full");
  EXPECT_EQ(default_text(field<v1::SimulateSpec>("model")), "sheet");
  EXPECT_EQ(default_text(field<v1::FitSpec>("film")), "A4");
  EXPECT_EQ(default_text(field<v1::SimulateSpec>("texture")), "");
}

TEST(FieldRules, HelpNamesRangeChoicesAndDefault) {
  EXPECT_EQ(help_text(field<v1::SimulateSpec>("dpi")),
            "from 20 to 2400 dots per inch; default 300");
  EXPECT_EQ(help_text(field<v1::SimulateSpec>("model")), "sheet, stokes; default sheet");
  EXPECT_EQ(help_text(field<v1::MoveToRequest>("position_mm")), "in mm");
  EXPECT_EQ(help_text(field<v1::SimulateSpec>("texture")), "");
}

TEST(FieldRules, FlagsAreExplainedByTheCommentAndTheRules) {
  EXPECT_EQ(flag_help(field<v1::SimulateSpec>("dpi")),
            "Resolution of the film image (from 20 to 2400 dots per inch; default 300)");
  EXPECT_EQ(flag_help(field<v1::PredictSpec>("dpi")), flag_help(field<v1::SimulateSpec>("dpi")));
  EXPECT_EQ(flag_help(field<v1::SimulateSpec>("texture")),
            "The object's texture: PNG, JPEG or TIFF (default: the model's own materials)");
  EXPECT_EQ(
      flag_help(field<v1::DipSpec>("retract_speed_mm_per_s")),
      "Speed of the retraction (above 0 and at most 1000 mm/s; default: that of the descent)");
  EXPECT_EQ(
      flag_help(field<v1::SimulateSpec>("calibration")),
      "Use this calibration instead of --pose, --film and --scale: calibrations/3, 3 or active");
}

TEST(FieldRules, FlagsAreTheFieldsNamesWithDashes) {
  EXPECT_EQ(flag_of(field<v1::SimulateSpec>("dip_speed_mm_per_s")), "dip-speed-mm-per-s");
  EXPECT_EQ(flag_of(field<v1::SimulateSpec>("mesh")), "mesh");
}

}  // namespace
}  // namespace hydroprint::rules
