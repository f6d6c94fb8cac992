#include "daemon/auth/visibility.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <functional>
#include <vector>

#include "daemon/auth/authenticator.h"
#include "daemon/platform/resource_names.h"
#include "daemon/store/to_proto.h"

namespace hydroprint::daemon {
namespace {

using auth::Caller;
using auth::Role;
using google::protobuf::Message;
using Field = google::protobuf::FieldDescriptor;

bool is_theirs(const Caller& caller, const std::string& owner) {
  return caller.role >= Role::kOperator || caller.name == owner;
}

tl::unexpected<Error> not_yours(const Caller& caller, const Job& job, const char* what) {
  auto refused = fail(Code::kPermissionDenied,
                      job_name(job.id) + ": belongs to " + job.definition.owner + ", not to " +
                          caller.name + "; " + what,
                      ErrorReason::NOT_YOURS);
  refused.value().metadata = {{"job", job_name(job.id)}, {"owner", job.definition.owner}};
  return refused;
}

// Collects the input files that refer to an asset, in a message and its nested messages.
void find_files(const Message& message, std::vector<InputFile>& found) {
  if (message.GetDescriptor() == v1::InputFile::descriptor()) {
    v1::InputFile file;
    file.CopyFrom(message);
    const auto hash = parse_asset_name(file.asset());
    if (hash) found.push_back({file.name(), *hash});
    return;
  }
  const auto& reflection = *message.GetReflection();
  std::vector<const Field*> fields;
  reflection.ListFields(message, &fields);
  for (const Field* const field : fields) {
    if (field->cpp_type() != Field::CPPTYPE_MESSAGE || field->is_map()) continue;
    const int count = field->is_repeated() ? reflection.FieldSize(message, field) : 1;
    for (int i = 0; i < count; ++i) {
      find_files(field->is_repeated() ? reflection.GetRepeatedMessage(message, field, i)
                                      : reflection.GetMessage(message, field),
                 found);
    }
  }
}

// Removes all files from a message and its nested messages.
void clear_files(Message& message) {
  const auto& reflection = *message.GetReflection();
  std::vector<const Field*> fields;
  reflection.ListFields(message, &fields);
  for (const Field* const field : fields) {
    if (field->cpp_type() != Field::CPPTYPE_MESSAGE || field->is_map()) continue;
    if (field->message_type() == v1::InputFile::descriptor()) {
      reflection.ClearField(&message, field);
    } else if (field->is_repeated()) {
      for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
        clear_files(*reflection.MutableRepeatedMessage(&message, field, i));
      }
    } else {
      clear_files(*reflection.MutableMessage(&message, field));
    }
  }
}

// Collects the names of jobs ("jobs/7", and names below them) in a message and its nested messages.
void find_jobs(const Message& message, std::vector<std::string>& found) {
  const auto& reflection = *message.GetReflection();
  const auto keep = [&](const std::string& text) {
    if (text.starts_with("jobs/")) found.push_back(text.substr(0, text.find('/', 5)));
  };
  std::vector<const Field*> fields;
  reflection.ListFields(message, &fields);
  for (const Field* const field : fields) {
    const int count = field->is_repeated() ? reflection.FieldSize(message, field) : 1;
    for (int i = 0; i < count && !field->is_map(); ++i) {
      if (field->cpp_type() == Field::CPPTYPE_STRING) {
        keep(field->is_repeated() ? reflection.GetRepeatedString(message, field, i)
                                  : reflection.GetString(message, field));
      } else if (field->cpp_type() == Field::CPPTYPE_MESSAGE) {
        find_jobs(field->is_repeated() ? reflection.GetRepeatedMessage(message, field, i)
                                       : reflection.GetMessage(message, field),
                  found);
      }
    }
  }
}

}  // namespace

bool may_see(const Caller& caller, const Job& job) {
  return job.shared || is_theirs(caller, job.definition.owner);
}

Status check_may_see(const Caller& caller, const Job& job) {
  if (may_see(caller, job)) return {};
  return not_yours(caller, job, "ask the owner to share the job");
}

Status check_may_change(const Caller& caller, const Job& job) {
  if (is_theirs(caller, job.definition.owner)) return {};
  return not_yours(caller, job, "ask the owner or an operator to do this");
}

v1::Job shown_to(const Caller& caller, const Job& job) {
  v1::Job out = to_message(job);
  if (!may_see(caller, job)) clear_files(out);
  return out;
}

void hide_files(const Caller& caller, v1::Calibration& calibration) {
  if (!is_theirs(caller, calibration.owner())) clear_files(calibration);
}

AssetUser asset_user(const Caller& caller) { return {caller.name, caller.role >= Role::kOperator}; }

Status check_may_use_files(const Caller& caller, const Message& request, Database& database) {
  std::vector<InputFile> files;
  find_files(request, files);
  return check_may_use(database, files, asset_user(caller));
}

Status check_may_create(const Caller& caller, Role needed, const v1::Job& job, JobStore& jobs,
                        Database& database) {
  HP_RETURN_IF_ERROR(check_role(caller, needed));
  const Message* const spec = spec_of(job);
  if (spec == nullptr || caller.role >= Role::kOperator) return {};
  std::vector<std::string> names;
  find_jobs(*spec, names);
  for (const std::string& name : names) {
    const auto id = parse_job_name(name);
    if (!id) continue;  // not a job; the check of the field itself reports it
    HP_ASSIGN_OR_RETURN(const Job other, jobs.get(*id));
    HP_RETURN_IF_ERROR(check_may_see(caller, other));
  }
  return check_may_use_files(caller, *spec, database);
}

}  // namespace hydroprint::daemon
