#include "daemon/jobs/spec_files.h"

#include <fmt/format.h>

#include <functional>
#include <set>

#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::daemon {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using FileVisitor = std::function<Status(const FieldDescriptor&, const v1::InputFile&)>;

// Calls `visit` for each file. Specs have files only at their top level.
Status each_file(const Message& spec, const FileVisitor& visit) {
  const auto& reflection = *spec.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(spec, &fields);
  for (const FieldDescriptor* const field : fields) {
    if (field->message_type() != v1::InputFile::descriptor()) continue;
    const int count = field->is_repeated() ? reflection.FieldSize(spec, field) : 1;
    for (int i = 0; i < count; ++i) {
      const Message& file = field->is_repeated() ? reflection.GetRepeatedMessage(spec, field, i)
                                                 : reflection.GetMessage(spec, field);
      HP_RETURN_IF_ERROR(visit(*field, static_cast<const v1::InputFile&>(file)));
    }
  }
  return {};
}

// Returns a name that occurs twice, or that is also the folder of another file; empty if there is
// none.
std::string ambiguous_name(const std::vector<InputFile>& inputs) {
  std::set<std::string> names;
  for (const InputFile& file : inputs) {
    if (!names.insert(file.name).second) return file.name;
  }
  for (const std::string& name : names) {
    for (std::size_t end = name.find('/'); end != std::string::npos;
         end = name.find('/', end + 1)) {
      if (names.contains(name.substr(0, end))) return name.substr(0, end);
    }
  }
  return "";
}

}  // namespace

Result<std::vector<InputFile>> input_files(const Message& spec, const std::string& path) {
  std::vector<InputFile> out;
  const auto add = [&](const FieldDescriptor& field, const v1::InputFile& file) -> Status {
    const std::string place = path + "." + field.name();
    HP_RETURN_IF_ERROR(check_file_name(place + ".name", file.name()));
    const auto asset = parse_asset_name(file.asset());
    if (!asset) {
      Error error = asset.error();
      error.message = place + ".asset: " + error.message;
      return tl::unexpected(std::move(error));
    }
    out.push_back({file.name(), *asset});
    return {};
  };
  HP_RETURN_IF_ERROR(each_file(spec, add));
  if (const std::string name = ambiguous_name(out); !name.empty()) {
    return fail(
        Code::kInvalidArgument,
        fmt::format("{}: the name \"{}\" is used for two files; use a different name for each file",
                    path, name),
        "NAME_INVALID");
  }
  return out;
}

std::string first_file_name(const Message& spec) {
  std::string single, listed;
  (void)each_file(spec, [&](const FieldDescriptor& field, const v1::InputFile& file) -> Status {
    std::string& first = field.is_repeated() ? listed : single;
    if (first.empty()) first = file.name();
    return {};
  });
  return single.empty() ? listed : single;
}

}  // namespace hydroprint::daemon
