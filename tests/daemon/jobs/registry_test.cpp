#include "daemon/jobs/registry.h"

#include <gtest/gtest.h>

#include <set>

namespace hydroprint::daemon {
namespace {

v1::Job job_of(const google::protobuf::FieldDescriptor& field) {
  v1::Job job;
  (void)job.GetReflection()->MutableMessage(&job, &field);
  return job;
}

TEST(JobKinds, EveryFieldOfTheOneofHasAKind) {
  const auto& specs = *v1::Job::descriptor()->FindOneofByName("spec");
  for (int i = 0; i < specs.field_count(); ++i) {
    const auto kind = kind_of(job_of(*specs.field(i)));
    ASSERT_TRUE(kind) << specs.field(i)->name() << " has no file in daemon/jobs/kinds";
    EXPECT_EQ(&(*kind)->field(), specs.field(i));
  }
  EXPECT_EQ(job_kinds().size(), static_cast<std::size_t>(specs.field_count()));
}

TEST(JobKinds, AreFoundByTheVerbOfAStoredJob) {
  std::set<std::string> names;
  for (const JobKind* const kind : job_kinds()) {
    Job job;
    job.definition.work.verb = kind->name();
    EXPECT_EQ(kind_of(job).value(), kind);
    EXPECT_TRUE(names.insert(kind->name()).second) << kind->name();
  }
  EXPECT_TRUE(names.contains("print-image"));
  EXPECT_EQ(kind_of(Job()).error().reason, ErrorReason::STORE_FAILED);
}

TEST(JobKinds, MissingSpecIsRefusedWithTheListOfKinds) {
  const auto refused = kind_of(v1::Job());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "job");
  for (const JobKind* const kind : job_kinds()) {
    EXPECT_NE(refused.error().message.find(kind->field().name()), std::string::npos);
  }
}

TEST(JobKinds, OnlyComputedJobsCanBeRetriedOrCached) {
  for (const JobKind* const kind : job_kinds()) {
    const bool computed = kind->traits().computed;
    EXPECT_EQ(kind->executor() == ExecutorId::kWorkers, computed) << kind->name();
    EXPECT_EQ(kind->why_no_retry().empty(), computed) << kind->name();
    EXPECT_TRUE(computed || !kind->is_cacheable()) << kind->name();
  }
}

}  // namespace
}  // namespace hydroprint::daemon
