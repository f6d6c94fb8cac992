#include "proto/rules/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hydroprint/v1/asset_service.pb.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/event_service.pb.h"
#include "hydroprint/v1/job.pb.h"
#include "hydroprint/v1/lease_service.pb.h"
#include "hydroprint/v1/rig_service.pb.h"

namespace hydroprint::rules {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Field and problem of each violation.
using Violations = std::vector<std::pair<std::string, std::string>>;

Violations violations_of(const google::protobuf::Message& message,
                         const FormatChecks& formats = {}) {
  Violations out;
  for (const Violation& violation : check(message, formats)) {
    out.emplace_back(violation.field, violation.problem);
  }
  return out;
}

v1::SimulateSpec spec_with_mesh() {
  v1::SimulateSpec spec;
  spec.mutable_mesh()->set_name("spot.obj");
  return spec;
}

v1::Pose upright() {
  v1::Pose pose;
  for (const double x : {1, 0, 0, 0}) pose.add_rotation_wxyz(x);
  for (const double x : {1, 2, 3}) pose.add_translation_mm(x);
  return pose;
}

// The field of the only violation; "" if there is none.
std::string wrong_field(const google::protobuf::Message& message) {
  const auto violations = check(message);
  EXPECT_LE(violations.size(), 1U);
  return violations.empty() ? "" : violations.front().field;
}

TEST(Check, AcceptsASpecWithoutOptionalFields) {
  EXPECT_EQ(violations_of(spec_with_mesh()), Violations());
}

TEST(Check, ReportsAllWrongFieldsInTheirOrder) {
  v1::Job job;
  job.set_priority(10);
  v1::SimulateSpec& spec = *job.mutable_simulate();
  spec.set_dpi(2401);
  spec.set_threads(0);
  spec.set_scale(-1);
  const Violations expected = {
      {"priority", "must be from 0 to 9"},
      {"simulate.mesh", "is missing"},
      {"simulate.scale", "must be from 0.000001 to 1000000 mm"},
      {"simulate.dpi", "must be from 20 to 2400 dots per inch"},
      {"simulate.threads", "must be from 1 to 256"},
  };
  EXPECT_EQ(violations_of(job), expected);
}

TEST(Check, PathsBeginWithTheGivenOne) {
  v1::DipSpec spec;
  spec.set_hold_s(601);
  const auto violations = check(spec, {}, "dip");
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].field, "dip.hold_s");
}

TEST(Check, BoundsBelongToTheRangeUnlessTheyAreExcluded) {
  v1::SimulateSpec spec = spec_with_mesh();
  for (const double dpi : {20.0, 2400.0, 300.5}) {
    spec.set_dpi(dpi);
    EXPECT_EQ(wrong_field(spec), "") << dpi;
  }
  for (const double dpi : {19.999, 2400.001, 0.0, -300.0, kNaN, kInfinity, -kInfinity}) {
    spec.set_dpi(dpi);
    EXPECT_EQ(wrong_field(spec), "dpi") << dpi;
  }
  v1::PrintImageSpec print;
  print.mutable_film_image()->set_name("film.png");
  print.set_ink_limit(4);
  EXPECT_EQ(wrong_field(print), "");
  print.set_ink_limit(std::numeric_limits<double>::min());
  EXPECT_EQ(wrong_field(print), "");
  print.set_ink_limit(0);
  EXPECT_EQ(wrong_field(print), "ink_limit");
}

TEST(Check, NumbersWithoutARangeMustBeFinite) {
  v1::JogRequest request;
  request.set_speed_mm_per_s(-7);
  EXPECT_EQ(wrong_field(request), "");
  for (const double speed : {kNaN, kInfinity}) {
    request.set_speed_mm_per_s(speed);
    EXPECT_EQ(violations_of(request), (Violations{{"speed_mm_per_s", "must be a finite number"}}));
  }
}

TEST(Check, AMissingNumberIsReportedOnlyIfItIsRequired) {
  EXPECT_EQ(violations_of(v1::JogRequest()), (Violations{{"speed_mm_per_s", "is missing"}}));
  v1::MoveToRequest request;
  request.set_position_mm(0);
  EXPECT_EQ(wrong_field(request), "")
      << "position 0 is valid, and a missing speed means the default";
}

TEST(Check, ARequiredTextMustNotBeEmpty) {
  v1::BreakLeaseRequest request;
  EXPECT_EQ(violations_of(request), (Violations{{"reason", "is missing"}}));
  request.set_reason("left");
  EXPECT_EQ(wrong_field(request), "");
}

TEST(Check, AFieldThatAnotherOneReplacesIsRefusedBesideIt) {
  v1::SimulateSpec spec = spec_with_mesh();
  spec.set_calibration("calibrations/active");
  EXPECT_EQ(violations_of(spec), Violations());
  spec.set_scale(0);
  spec.set_film("A4");
  const std::string problem = "is taken from calibration; leave one of the two out";
  EXPECT_EQ(violations_of(spec), (Violations{{"scale", problem}, {"film", problem}}));
  spec.clear_calibration();
  EXPECT_EQ(wrong_field(spec), "scale");
}

TEST(Check, ARequiredFieldMayBeMissingIfItsAlternativeIsSet) {
  v1::TemplateSpec spec;
  EXPECT_EQ(violations_of(spec), (Violations{{"mesh", "is missing"}}));
  spec.set_simulate_job("jobs/7");
  EXPECT_EQ(violations_of(spec), Violations());
}

TEST(Check, TextsAreShortAndWithoutControlCharacters) {
  v1::PrintImageSpec spec;
  spec.mutable_film_image()->set_name("film.png");
  spec.set_job_name(std::string(200, 'x'));
  EXPECT_EQ(wrong_field(spec), "");
  spec.set_job_name(std::string(201, 'x'));
  EXPECT_EQ(violations_of(spec),
            (Violations{{"job_name", "is longer than 200 bytes; shorten it"}}));
  for (const char* bad : {"a\nb", "\x1b[2J", "a\x7f"}) {
    spec.set_job_name(bad);
    EXPECT_EQ(violations_of(spec),
              (Violations{{"job_name", "has control characters; leave them out"}}));
  }
  spec.set_job_name("Ärztin");
  EXPECT_EQ(wrong_field(spec), "");
}

TEST(Check, BytesMayHoldAnythingButNotTooMuch) {
  v1::UploadChunkRequest request;
  request.set_data(std::string(1 << 20, '\n'));
  EXPECT_EQ(wrong_field(request), "");
  request.set_data(std::string((1 << 20) + 1, 'x'));
  EXPECT_EQ(wrong_field(request), "data");
}

TEST(Check, NamesOutsideTheListAreRefusedAndShown) {
  v1::WatchEventsRequest request;
  for (const char* topic : {"job", "rig", "queue", "lease"}) request.add_topics(topic);
  EXPECT_EQ(wrong_field(request), "");
  request.add_topics("jo\nb");
  request.add_topics("jab");
  EXPECT_EQ(violations_of(request),
            (Violations{{"topics", "must be job, rig, queue or lease, not \"jo?b\""}}));
}

TEST(Check, UnknownNumbersOfAnEnumAreRefused) {
  v1::SimulateSpec spec = spec_with_mesh();
  spec.set_model(v1::MODEL_STOKES);
  EXPECT_EQ(wrong_field(spec), "");
  spec.set_model(static_cast<v1::Model>(77));
  EXPECT_EQ(violations_of(spec), (Violations{{"model", "must be MODEL_SHEET or MODEL_STOKES"}}));
}

TEST(Check, ListsHaveAsManyValuesAsTheyMay) {
  v1::SimulateSpec spec = spec_with_mesh();
  for (int i = 0; i < 256; ++i) spec.add_extra_files()->set_name("a");
  EXPECT_EQ(wrong_field(spec), "");
  spec.add_extra_files();
  EXPECT_EQ(violations_of(spec), (Violations{{"extra_files", "must have at most 256 values"}}));
}

TEST(Check, APoseIsAUnitQuaternionAndThreeNumbers) {
  v1::SimulateSpec spec = spec_with_mesh();
  *spec.mutable_pose() = upright();
  EXPECT_EQ(wrong_field(spec), "");
  spec.mutable_pose()->set_rotation_wxyz(0, 1.002);
  EXPECT_EQ(violations_of(spec), (Violations{{"pose.rotation_wxyz", "must have length 1"}}));
  spec.mutable_pose()->set_rotation_wxyz(0, kNaN);
  EXPECT_EQ(wrong_field(spec), "pose.rotation_wxyz");
  spec.mutable_pose()->clear_rotation_wxyz();
  EXPECT_EQ(violations_of(spec), (Violations{{"pose.rotation_wxyz", "is missing"}}));
  *spec.mutable_pose() = upright();
  spec.mutable_pose()->add_translation_mm(0);
  EXPECT_EQ(violations_of(spec),
            (Violations{{"pose.translation_mm", "must have exactly 3 values"}}));
  *spec.mutable_pose() = upright();
  spec.mutable_pose()->set_translation_mm(1, kInfinity);
  EXPECT_EQ(violations_of(spec), (Violations{{"pose.translation_mm", "must be a finite number"}}));
}

TEST(Check, MessagesInAListAreNamedByTheirPlaces) {
  v1::SimulateSpec spec = spec_with_mesh();
  spec.add_extra_files()->set_name("a.mtl");
  spec.add_extra_files()->set_name(std::string(256, 'x'));
  spec.mutable_texture()->set_name(std::string(256, 'x'));
  const auto violations = check(spec);
  ASSERT_EQ(violations.size(), 2U);
  EXPECT_EQ(violations[0].field, "texture.name");
  EXPECT_EQ(violations[1].field, "extra_files[1].name");
}

TEST(Check, ReasonsAreSpecInvalidUnlessAFieldHasItsOwn) {
  v1::SimulateSpec spec = spec_with_mesh();
  spec.set_dpi(0);
  spec.mutable_texture()->set_name(std::string(256, 'x'));
  const auto violations = check(spec);
  ASSERT_EQ(violations.size(), 2U);
  EXPECT_EQ(violations[0].reason, ErrorReason::NAME_INVALID);
  EXPECT_EQ(violations[1].reason, ErrorReason::SPEC_INVALID);
}

TEST(Check, KeysAndValuesOfAMapAreTexts) {
  v1::Job job;
  (*job.mutable_labels())["line"] = "7";
  EXPECT_EQ(wrong_field(job), "");
  (*job.mutable_labels())["line"] = std::string(201, 'x');
  EXPECT_EQ(wrong_field(job), "labels");
  job.clear_labels();
  (*job.mutable_labels())["a\nb"] = "7";
  EXPECT_EQ(wrong_field(job), "labels");
  job.clear_labels();
  for (int i = 0; i < 33; ++i) (*job.mutable_labels())[std::to_string(i)] = "";
  EXPECT_EQ(violations_of(job), (Violations{{"labels", "must have at most 32 values"}}));
}

TEST(Check, DurationsHaveRangesInSeconds) {
  v1::RenewLeaseRequest request;
  request.mutable_ttl()->set_seconds(28800);
  EXPECT_EQ(wrong_field(request), "");
  request.mutable_ttl()->set_nanos(1);
  EXPECT_EQ(violations_of(request), (Violations{{"ttl", "must be from 1 second to 8 hours"}}));
  request.mutable_ttl()->set_seconds(0);
  request.mutable_ttl()->set_nanos(999'999'999);
  EXPECT_EQ(wrong_field(request), "ttl");
}

TEST(Check, FieldsThatTheDaemonSetsAreIgnored) {
  v1::Job job;
  job.set_state(static_cast<v1::Job::State>(99));
  job.set_progress_fraction(kNaN);
  job.mutable_dip_status()->set_contact_mm(kNaN);
  EXPECT_EQ(wrong_field(job), "");
}

TEST(Check, NotationsAreCheckedByTheirNames) {
  v1::SimulateSpec spec = spec_with_mesh();
  spec.set_film("A9");
  EXPECT_EQ(wrong_field(spec), "") << "without a format check, any film name is accepted";
  const FormatChecks formats = {
      {"film", [](const std::string& text) { return text == "A4" ? "" : text + " is unknown"; }}};
  EXPECT_EQ(violations_of(spec, formats), (Violations{{"film", "A9 is unknown"}}));
  spec.set_film("A4");
  EXPECT_EQ(violations_of(spec, formats), Violations());
  spec.set_film(std::string(301, 'x'));
  EXPECT_EQ(violations_of(spec, formats),
            (Violations{{"film", "is longer than 300 bytes; shorten it"}}));
}

}  // namespace
}  // namespace hydroprint::rules
