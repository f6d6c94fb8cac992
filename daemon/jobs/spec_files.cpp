#include "daemon/jobs/spec_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::daemon {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using FileVisitor =
    std::function<Status(const FieldDescriptor&, const std::string& place, const v1::InputFile&)>;

Status each_file(const Message& message, const std::string& path, const FileVisitor& visit);

Status each_file_in(const Message& value, const FieldDescriptor& field, const std::string& place,
                    const FileVisitor& visit) {
  if (value.GetDescriptor() == v1::InputFile::descriptor())
    return visit(field, place, static_cast<const v1::InputFile&>(value));
  return each_file(value, place, visit);
}

// Calls `visit` for each file in a message and its nested messages.
// @param path  place of the message, for errors
Status each_file(const Message& message, const std::string& path, const FileVisitor& visit) {
  const auto& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* const field : fields) {
    if (field->message_type() == nullptr || field->is_map()) continue;
    const std::string place = path + "." + field->name();
    if (!field->is_repeated()) {
      HP_RETURN_IF_ERROR(each_file_in(reflection.GetMessage(message, field), *field, place, visit));
      continue;
    }
    for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
      HP_RETURN_IF_ERROR(
          each_file_in(reflection.GetRepeatedMessage(message, field, i), *field, place, visit));
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
  const auto add = [&](const FieldDescriptor& field, const std::string& place,
                       const v1::InputFile& file) -> Status {
    HP_RETURN_IF_ERROR(check_file_name(place + ".name", file.name()));
    const auto asset = parse_asset_name(file.asset());
    if (!asset) {
      Error error = asset.error();
      error.message = place + ".asset: " + error.message;
      return tl::unexpected(std::move(error));
    }
    const InputFile input{file.name(), *asset};
    // Several layers of a paint may have the same picture.
    const bool is_of_layer = field.containing_type() == v1::PaintLayer::descriptor();
    if (!is_of_layer || std::ranges::find(out, input) == out.end()) out.push_back(input);
    return {};
  };
  HP_RETURN_IF_ERROR(each_file(spec, path, add));
  if (const std::string name = ambiguous_name(out); !name.empty()) {
    return fail(
        Code::kInvalidArgument,
        fmt::format("{}: the name \"{}\" is used for two files; use a different name for each file",
                    path, name),
        ErrorReason::NAME_INVALID);
  }
  return out;
}

std::string first_file_name(const Message& spec) {
  std::string single, listed;
  const auto keep = [&](const FieldDescriptor& field, const std::string&,
                        const v1::InputFile& file) -> Status {
    std::string& first = field.is_repeated() ? listed : single;
    if (first.empty()) first = file.name();
    return {};
  };
  (void)each_file(spec, {}, keep);
  return single.empty() ? listed : single;
}

}  // namespace hydroprint::daemon
