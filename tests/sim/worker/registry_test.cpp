#include "sim/worker/registry.h"

#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "hydroprint/v1/job.pb.h"

namespace hydroprint::worker {
namespace {

/// Kinds of jobs that run on the rig, the printer or the camera.
const std::set<std::string> kDaemonKinds = {"dip", "print", "capture"};

std::string verb_name(std::string kind) {
  std::replace(kind.begin(), kind.end(), '_', '-');
  return kind;
}

TEST(Registry, EveryKindOfJobThatTheWorkerComputesHasAVerbWithItsSpec) {
  const auto* const kinds = v1::Job::descriptor()->FindOneofByName("spec");
  ASSERT_NE(kinds, nullptr);
  const std::vector<Verb> all = verbs();
  for (int i = 0; i < kinds->field_count(); ++i) {
    const auto& kind = *kinds->field(i);
    const auto verb = std::find_if(all.begin(), all.end(),
                                   [&](const Verb& v) { return v.name == verb_name(kind.name()); });
    if (kDaemonKinds.contains(kind.name())) {
      EXPECT_EQ(verb, all.end()) << kind.name();
      continue;
    }
    ASSERT_NE(verb, all.end()) << kind.name() << " has no verb";
    EXPECT_EQ(verb->spec_template->GetDescriptor(), kind.message_type()) << kind.name();
  }
}

TEST(Registry, EverySpecHasAFieldForThreads) {
  for (const Verb& verb : verbs()) {
    EXPECT_NE(verb.spec_template->GetDescriptor()->FindFieldByName("threads"), nullptr)
        << verb.name;
  }
}

TEST(Registry, NamesAreUnique) {
  std::set<std::string> names;
  for (const Verb& verb : verbs()) EXPECT_TRUE(names.insert(verb.name).second) << verb.name;
}

}  // namespace
}  // namespace hydroprint::worker
