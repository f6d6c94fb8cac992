// Flags of specs with nested messages.
#include "proto/flags/field_flag.h"

#include <gtest/gtest.h>

#include <set>

#include "hydroprint/v1/job.pb.h"

namespace hydroprint::flags {
namespace {

namespace pb = google::protobuf;

/// Adds a flag for each field of a plan that is not a message, and parses a command line.
v1::PlanSpec parsed(const std::string& command_line) {
  v1::PlanSpec spec;
  CLI::App app;
  for (const pb::FieldDescriptor* field : fields_of(*v1::PlanSpec::descriptor())) {
    if (field->message_type() == nullptr) add_field(app, holder_of(spec, *field), *field);
  }
  app.parse(command_line);
  return spec;
}

TEST(FieldFlags, FieldsOfFlatMessagesAreAmongThoseOfTheSpec) {
  std::vector<std::string> flags;
  for (const pb::FieldDescriptor* field : fields_of(*v1::PlanSpec::descriptor()))
    flags.push_back(flag_of(*field));
  EXPECT_EQ(flags, (std::vector<std::string>{
                       "--mesh", "--texture", "--extra-files", "--scale", "--paint", "--project",
                       "--project-size-mm", "--project-turn-deg", "--immersions", "--film",
                       "--profile", "--dip-speed-mm-per-s", "--model", "--ink-passes", "--inertia",
                       "--tolerance-mm", "--dpi", "--threads", "--blend-mm"}));
}

TEST(FieldFlags, ValuesArriveInTheirMessages) {
  const v1::PlanSpec spec = parsed(
      "--scale 50 --film A3 --model stokes --ink-passes 0 --inertia --dpi 600 --blend-mm 7.5");
  EXPECT_EQ(spec.object().scale(), 50);
  EXPECT_EQ(spec.film().film(), "A3");
  EXPECT_EQ(spec.film().model(), v1::MODEL_STOKES);
  EXPECT_TRUE(spec.film().has_ink_passes());
  EXPECT_EQ(spec.film().ink_passes(), 0);
  EXPECT_TRUE(spec.film().inertia());
  EXPECT_EQ(spec.dpi(), 600);
  EXPECT_EQ(spec.blend_mm(), 7.5);
}

TEST(FieldFlags, EveryFieldOfASpecHasOneHolderAndAFlagOfItsOwn) {
  const auto& specs = *v1::Job::descriptor()->FindOneofByName("spec");
  for (int i = 0; i < specs.field_count(); ++i) {
    v1::Job job;
    pb::Message& spec = *job.GetReflection()->MutableMessage(&job, specs.field(i));
    std::set<std::string> flags;
    std::set<const pb::Descriptor*> flat;
    for (int f = 0; f < spec.GetDescriptor()->field_count(); ++f) {
      const pb::FieldDescriptor& field = *spec.GetDescriptor()->field(f);
      EXPECT_TRUE(!is_flat(field) || flat.insert(field.message_type()).second)
          << field.full_name() << ": another flat field has the same type";
    }
    for (const pb::FieldDescriptor* field : fields_of(*spec.GetDescriptor())) {
      EXPECT_TRUE(flags.insert(flag_of(*field)).second) << field->full_name();
      EXPECT_EQ(holder_of(spec, *field).GetDescriptor(), field->containing_type());
    }
  }
}

}  // namespace
}  // namespace hydroprint::flags
