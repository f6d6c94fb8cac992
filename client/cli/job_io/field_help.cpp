#include "client/cli/job_io/field_help.h"

#include <google/protobuf/descriptor.h>

#include <stdexcept>

#include "hydroprint/v1/field_rules.pb.h"
#include "proto/rules/field_rules.h"

namespace hydroprint::cli {
namespace {

const google::protobuf::FieldDescriptor& descriptor_of(const std::string& field) {
  const auto* found =
      google::protobuf::DescriptorPool::generated_pool()->FindFieldByName("hydroprint.v1." + field);
  if (found == nullptr || rules::rules_of(*found) == nullptr) {
    throw std::logic_error(field + " has no rules");
  }
  return *found;
}

}  // namespace

std::string field_help(const std::string& field) { return rules::flag_help(descriptor_of(field)); }

CLI::Validator field_range(const std::string& field) {
  const v1::FieldRules& rules = *rules::rules_of(descriptor_of(field));
  return CLI::Range(rules.min(), rules.max());
}

}  // namespace hydroprint::cli
