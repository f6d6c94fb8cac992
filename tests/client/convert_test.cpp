#include "client/convert.h"

#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

namespace hydroprint::client {
namespace {

namespace v1 = ::hydroprint::v1;
using google::protobuf::util::MessageDifferencer;

InputFile file(const std::string& name) { return {name, "assets/" + name}; }

/// All fields shared by simulate and predict.
Spec full_spec(Verb verb) {
  Spec spec;
  spec.verb = verb;
  spec.mesh = file("spot.obj");
  spec.extra_files = {file("spot.mtl"), file("film.json")};
  spec.profile = file("film.toml");
  spec.ink_image = file("ink.png");
  spec.scale = 50;
  spec.pose = PoseSpec{{0.6, 0, 0, 0.8}, {1.5, -2, 3}};
  spec.film = "polygon:film.json";
  spec.dpi = 600.5;
  spec.model = "sheet";
  spec.inertia = true;
  spec.ink_passes = 2;
  spec.depth_mm = 12.25;
  spec.dip_speed_mm_per_s = 0.1;
  spec.threads = 4;
  spec.artifacts = "map";
  return spec;
}

v1::Job message_of(const Spec& spec) {
  v1::Job job;
  const Status status = to_proto(spec, job);
  EXPECT_TRUE(status) << status.error().message;
  return job;
}

/// Fails unless all fields of the message are set and the conversion through Spec keeps them.
void expect_round_trip(const v1::Job& job, const google::protobuf::Message& message) {
  const auto& fields = *message.GetDescriptor();
  for (int i = 0; i < fields.field_count(); ++i) {
    const auto* field = fields.field(i);
    const auto& reflection = *message.GetReflection();
    EXPECT_TRUE(field->is_repeated() ? reflection.FieldSize(message, field) > 0
                                     : reflection.HasField(message, field))
        << field->full_name() << " is lost";
  }
  const Job back = from_proto(job);
  ASSERT_TRUE(back.spec);
  EXPECT_TRUE(MessageDifferencer::Equals(message_of(*back.spec), job))
      << message_of(*back.spec).DebugString() << job.DebugString();
}

TEST(Convert, EveryFieldOfSimulateIsConvertedBothWays) {
  Spec spec = full_spec(Verb::kSimulate);
  spec.texture = file("spot.png");
  spec.calibration = "calibrations/3";
  spec.allow_stale_calibration = true;
  const v1::Job job = message_of(spec);
  expect_round_trip(job, job.simulate());
  EXPECT_TRUE(job.simulate().inertia());
}

TEST(Convert, EveryFieldOfPredictIsConvertedBothWays) {
  Spec spec = full_spec(Verb::kPredict);
  spec.film_image = file("film.png");
  spec.motion = file("driven.csv");
  const v1::Job job = message_of(spec);
  expect_round_trip(job, job.predict());
  EXPECT_TRUE(job.predict().inertia());
}

TEST(Convert, EveryFieldOfValidateIsConvertedBothWays) {
  Spec spec;
  spec.verb = Verb::kValidate;
  spec.only = {"bowl", "accuracy"};
  spec.quick = true;
  spec.threads = 2;
  const v1::Job job = message_of(spec);
  expect_round_trip(job, job.validate());
}

TEST(Convert, EveryFieldOfPrintImageIsConvertedBothWays) {
  Spec spec;
  spec.verb = Verb::kPrintImage;
  spec.simulate_job = "jobs/7";
  spec.film_image = file("film.png");
  spec.extra_files = {file("film.json")};
  spec.film = "polygon:film.json";
  spec.dpi = 600.5;
  spec.threads = 4;
  spec.page = {"A3", 4.2,  "mug 7", "2025-03-14",  40,  15,
               true, true, "cmyk",  file("p.icc"), 2.5, {"pdf", "tiff"}};
  const v1::Job job = message_of(spec);
  expect_round_trip(job, job.print_image());
  EXPECT_EQ(job.print_image().colours(), v1::COLOURS_CMYK);
  spec.page.colours = "hsv";
  v1::Job refused;
  EXPECT_EQ(to_proto(spec, refused).error().code, Code::kInvalidArgument);
}

TEST(Convert, EveryFieldOfTemplateIsConvertedBothWays) {
  Spec spec;
  spec.verb = Verb::kTemplate;
  spec.simulate_job = "jobs/7";
  spec.mesh = file("spot.obj");
  spec.extra_files = {file("film.json")};
  spec.scale = 50;
  spec.pose = PoseSpec{{0.6, 0, 0, 0.8}, {1.5, -2, 3}};
  spec.film = "polygon:film.json";
  spec.threads = 2;
  spec.page.paper = "A3";
  spec.page.printer_margin_mm = 3;
  spec.page.job_name = "mug 7";
  spec.page.date = "2025-03-14";
  const v1::Job job = message_of(spec);
  expect_round_trip(job, job.template_());
}

TEST(Convert, EveryFieldOfCalibrateIsConvertedBothWays) {
  Spec spec;
  spec.verb = Verb::kCalibrate;
  spec.mesh = file("spot.obj");
  spec.extra_files = {file("film.json")};
  spec.scale = 50;
  spec.pose = PoseSpec{{0.6, 0, 0, 0.8}, {1.5, -2, 3}};
  spec.film = "polygon:film.json";
  spec.threads = 2;
  spec.scan = {{"jobs/5"},       {file("frames/frames.json")}, file("layout.toml"),
               "calibrations/2", file("camera.json"),          -3.5};
  const v1::Job job = message_of(spec);
  expect_round_trip(job, job.calibrate());
}

TEST(Convert, EveryFieldOfCalibrateCameraIsConvertedBothWays) {
  Spec spec;
  spec.verb = Verb::kCalibrateCamera;
  spec.threads = 2;
  spec.scan.capture_jobs = {"jobs/5", "jobs/6"};
  spec.scan.frames = {file("view1/frames.json")};
  const v1::Job job = message_of(spec);
  expect_round_trip(job, job.calibrate_camera());
}

TEST(Convert, ACaptureHasADuration) {
  v1::Job message;
  message.mutable_capture()->set_seconds(2.5);
  message.set_state(v1::Job::INTERRUPTED);
  const Job job = from_proto(message);
  EXPECT_EQ(job.capture_s, 2.5);
  EXPECT_TRUE(is_finished(job)) << "a capture cannot be repeated";
}

TEST(Convert, APrintHasItsPrintImageJob) {
  v1::Job message;
  message.mutable_print()->set_print_image_job("jobs/8");
  message.set_state(v1::Job::INTERRUPTED);
  const Job job = from_proto(message);
  EXPECT_EQ(job.print_image_job, "jobs/8");
  EXPECT_FALSE(job.spec);
  EXPECT_TRUE(is_finished(job));
}

TEST(Convert, UnsetFieldsStayUnset) {
  Spec spec;
  spec.mesh = file("spot.obj");
  const v1::Job job = message_of(spec);
  v1::Job mesh_alone;
  mesh_alone.mutable_simulate()->mutable_mesh()->set_name("spot.obj");
  mesh_alone.mutable_simulate()->mutable_mesh()->set_asset("assets/spot.obj");
  EXPECT_TRUE(MessageDifferencer::Equals(job, mesh_alone)) << job.DebugString();
}

TEST(Convert, UnknownNamesAreRefused) {
  Spec spec = full_spec(Verb::kSimulate);
  v1::Job job;
  spec.model = "honey";
  EXPECT_EQ(to_proto(spec, job).error().code, Code::kInvalidArgument);
  spec = full_spec(Verb::kSimulate);
  spec.artifacts = "some";
  EXPECT_EQ(to_proto(spec, job).error().code, Code::kInvalidArgument);
}

}  // namespace
}  // namespace hydroprint::client
