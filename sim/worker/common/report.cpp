#include "sim/worker/common/report.h"

#include <google/protobuf/message.h>
#include <google/protobuf/reflection.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "proto/write_json.h"
#include "sim/base/artifact_file.h"
#include "sim/base/file_digest.h"
#include "sim/base/utf8.h"

namespace hydroprint::worker {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

void repair_text(Message& message, const FieldDescriptor& field) {
  const auto& reflection = *message.GetReflection();
  if (!field.is_repeated())
    return reflection.SetString(&message, &field,
                                valid_utf8(reflection.GetString(message, &field)));
  for (int i = 0; i < reflection.FieldSize(message, &field); ++i) {
    reflection.SetRepeatedString(&message, &field, i,
                                 valid_utf8(reflection.GetRepeatedString(message, &field, i)));
  }
}

bool is_finite(const Message& message, const FieldDescriptor& field) {
  const auto& reflection = *message.GetReflection();
  if (!field.is_repeated()) return std::isfinite(reflection.GetDouble(message, &field));
  const auto numbers = reflection.GetRepeatedFieldRef<double>(message, &field);
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

void visit_messages(Message& message, const FieldDescriptor& field) {
  const auto& reflection = *message.GetReflection();
  if (!field.is_repeated()) return make_writable(*reflection.MutableMessage(&message, &field));
  for (int i = 0; i < reflection.FieldSize(message, &field); ++i)
    make_writable(*reflection.MutableRepeatedMessage(&message, &field, i));
}

}  // namespace

Status add_inputs(v1::RunFacts& run, const std::vector<InputPath>& files) {
  for (const InputPath& file : files) {
    if (file.path.empty()) continue;
    HP_ASSIGN_OR_RETURN(FileDigest digest, digest_file(file.path));
    v1::RunFacts::Input& input = *run.add_inputs();
    input.set_role(file.role);
    input.set_path(file.path.string());
    input.set_sha256(std::move(digest.sha256));
    input.set_size_bytes(static_cast<double>(digest.size_bytes));
  }
  return {};
}

void make_writable(Message& message) {
  std::vector<const FieldDescriptor*> fields;
  message.GetReflection()->ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    switch (field->cpp_type()) {
      case FieldDescriptor::CPPTYPE_STRING:
        repair_text(message, *field);
        break;
      case FieldDescriptor::CPPTYPE_DOUBLE:
        if (!is_finite(message, *field)) message.GetReflection()->ClearField(&message, field);
        break;
      case FieldDescriptor::CPPTYPE_MESSAGE:
        visit_messages(message, *field);
        break;
      default:
        break;
    }
  }
}

Status write_message(const std::filesystem::path& path, Message& message) {
  make_writable(message);
  HP_ASSIGN_OR_RETURN(const std::string text, json_file_of(message));
  return image::write_artifact(path, text);
}

std::string artifacts_line(const std::filesystem::path& dir, const v1::RunFacts& run) {
  std::string files;
  for (const std::string& name : run.artifacts()) files += name + " ";
  return dir.string() + ": " + files + "report.json\n";
}

}  // namespace hydroprint::worker
