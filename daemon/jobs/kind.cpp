#include "daemon/jobs/kind.h"

#include <algorithm>
#include <vector>

#include "daemon/jobs/spec_files.h"
#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

const FieldDescriptor& field_with(const google::protobuf::Descriptor& spec) {
  const auto& specs = *v1::Job::descriptor()->FindOneofByName("spec");
  int i = 0;
  while (specs.field(i)->message_type() != &spec) ++i;
  return *specs.field(i);
}

std::string with_dashes(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

/// Returns the name of the earlier job that a spec refers to in a single (not repeated) field;
/// empty if the spec refers to no job.
std::string earlier_job_name(const Message& spec) {
  std::vector<const FieldDescriptor*> fields;
  spec.GetReflection()->ListFields(spec, &fields);
  for (const FieldDescriptor* const field : fields) {
    if (field->is_repeated() || field->cpp_type() != FieldDescriptor::CPPTYPE_STRING) continue;
    std::string text = spec.GetReflection()->GetString(spec, field);
    if (parse_job_name(text)) return text;
  }
  return {};
}

}  // namespace

JobKind::JobKind(const google::protobuf::Descriptor& spec)
    : field_(field_with(spec)), name_(with_dashes(field_.name())) {}

std::string JobKind::subject(const Message& shown) const {
  const std::string earlier = earlier_job_name(shown);
  return earlier.empty() ? first_file_name(shown) : earlier;
}

Result<std::optional<NewCalibration>> JobKind::calibration(const Job&, const v1::JobReport&) const {
  return std::optional<NewCalibration>();
}

}  // namespace hydroprint::daemon
