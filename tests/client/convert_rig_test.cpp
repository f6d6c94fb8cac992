#include <google/protobuf/util/message_differencer.h>
#include <google/protobuf/util/time_util.h>
#include <gtest/gtest.h>

#include "client/convert.h"

namespace hydroprint::client {
namespace {

namespace v1 = ::hydroprint::v1;
using google::protobuf::util::MessageDifferencer;
using google::protobuf::util::TimeUtil;

TEST(ConvertRig, EveryFieldOfADipIsConvertedBothWays) {
  DipSpec spec;
  spec.simulate_job = "jobs/7";
  spec.yes_to_all = true;
  spec.calibration = "calibrations/3";
  spec.allow_stale_calibration = true;
  double value = 1;
  for (auto* field :
       {&spec.depth_mm, &spec.speed_mm_per_s, &spec.hold_s, &spec.retract_speed_mm_per_s,
        &spec.clearance_mm, &spec.film_area_mm2, &spec.activator_ml_per_m2, &spec.soak_s,
        &spec.activator_wait_s, &spec.activation_window_s, &spec.water_temperature_c})
    *field = value++;
  const v1::DipSpec message = to_proto(spec);
  const auto& fields = *message.GetDescriptor();
  for (int i = 0; i < fields.field_count(); ++i)
    EXPECT_TRUE(message.GetReflection()->HasField(message, fields.field(i)))
        << fields.field(i)->full_name() << " is lost";
  EXPECT_TRUE(MessageDifferencer::Equals(to_proto(from_proto(message)), message));
  EXPECT_EQ(message.soak_s(), 8);
  EXPECT_TRUE(MessageDifferencer::Equals(to_proto(DipSpec()), v1::DipSpec()))
      << "unset fields stay unset";
}

TEST(ConvertRig, NamesMatchTheApi) {
  for (int i = 1; v1::Rig::State_IsValid(i); ++i) {
    v1::Rig rig;
    rig.set_state(static_cast<v1::Rig::State>(i));
    EXPECT_EQ(name_of(from_proto(rig).state), v1::Rig::State_Name(rig.state()));
  }
  for (int i = 1; v1::Motion::Outcome_IsValid(i); ++i) {
    v1::Rig rig;
    rig.mutable_motion()->set_outcome(static_cast<v1::Motion::Outcome>(i));
    EXPECT_EQ(name_of(from_proto(rig).motion->outcome),
              v1::Motion::Outcome_Name(rig.motion().outcome()));
  }
  for (int i = 1; v1::DipStatus::Step_IsValid(i); ++i) {
    v1::DipStatus status;
    status.set_step(static_cast<v1::DipStatus::Step>(i));
    EXPECT_EQ(name_of(from_proto(status).step), v1::DipStatus::Step_Name(status.step()));
    EXPECT_EQ(to_proto(from_proto(status).step), status.step());
  }
  for (int i = 1; v1::Job::State_IsValid(i); ++i) {
    v1::Job job;
    job.set_state(static_cast<v1::Job::State>(i));
    EXPECT_EQ(name_of(from_proto(job).state), v1::Job::State_Name(job.state()));
    EXPECT_EQ(to_proto(from_proto(job).state), job.state());
  }
}

TEST(ConvertRig, AStateOfANewerDaemonIsUnknown) {
  v1::Rig rig;
  rig.set_state(static_cast<v1::Rig::State>(99));
  EXPECT_EQ(from_proto(rig).state, RigState::kUnknown);
}

TEST(ConvertRig, TheRigKeepsAllFieldsOfItsMessage) {
  v1::Rig message;
  message.set_cause("ALARM");
  message.set_trouble("reset it");
  message.set_homed(true);
  message.set_position_mm(12.5);
  message.set_alarm_code(0x30);
  *message.mutable_sample_time() = TimeUtil::MillisecondsToTimestamp(1234);
  message.mutable_motion()->set_number(7);
  message.mutable_motion()->set_kind(v1::Motion::JOG);
  message.mutable_motion()->set_at_rest(true);
  message.mutable_axis()->set_is_virtual(true);
  message.mutable_axis()->set_max_mm(298);
  message.mutable_link_quality()->set_missed_polls(3);
  message.mutable_lease()->set_holder("alice");
  message.set_dip("jobs/7");
  const Rig rig = from_proto(message);
  EXPECT_EQ(rig.cause, "ALARM");
  EXPECT_EQ(rig.trouble, "reset it");
  EXPECT_TRUE(rig.homed);
  EXPECT_FALSE(rig.stop_button);
  EXPECT_EQ(rig.position_mm, 12.5);
  EXPECT_FALSE(rig.velocity_mm_per_s);
  EXPECT_EQ(rig.alarm_code, 0x30);
  EXPECT_EQ(rig.sample_time->time_since_epoch(), std::chrono::milliseconds(1234));
  EXPECT_EQ(rig.motion->number, 7U);
  EXPECT_EQ(rig.motion->kind, "JOG");
  EXPECT_TRUE(rig.motion->at_rest);
  EXPECT_TRUE(rig.axis->is_virtual);
  EXPECT_EQ(rig.axis->max_mm, 298);
  EXPECT_EQ(rig.link_quality.missed_polls, 3U);
  EXPECT_EQ(rig.lease->holder, "alice");
  EXPECT_EQ(rig.dip, "jobs/7");
  const Rig nothing = from_proto(v1::Rig());
  EXPECT_FALSE(nothing.motion || nothing.axis || nothing.lease || nothing.sample_time);
}

TEST(ConvertRig, AnInterruptedDipIsFinishedButAComputationIsNot) {
  v1::Job message;
  message.set_state(v1::Job::INTERRUPTED);
  message.mutable_simulate();
  EXPECT_FALSE(is_finished(from_proto(message)));
  message.mutable_dip();
  message.mutable_dip_status()->set_step(v1::DipStatus::DESCEND);
  message.mutable_dip_status()->add_warnings("late");
  message.mutable_dip_status()->set_contact_mm(30);
  const Job job = from_proto(message);
  EXPECT_TRUE(is_finished(job));
  EXPECT_EQ(job.dip_status->warnings, std::vector<std::string>{"late"});
  EXPECT_EQ(job.dip_status->contact_mm, 30);
}

}  // namespace
}  // namespace hydroprint::client
