#include "sim/worker/common/flags.h"

#include <fmt/format.h>
#include <google/protobuf/message.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <vector>

#include "hydroprint/v1/spec.pb.h"
#include "sim/base/checked_json.h"
#include "sim/base/pose_file.h"
#include "sim/worker/common/fields.h"

namespace hydroprint::worker {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// The names of a choice on the command line: "sheet" for MODEL_SHEET. The first value of each enum
/// (MODEL_UNSPECIFIED) has no name there.
std::vector<std::string> choices(const google::protobuf::EnumDescriptor& type) {
  const std::string& unspecified = type.value(0)->name();
  const std::size_t prefix = unspecified.size() - std::string("UNSPECIFIED").size();
  std::vector<std::string> names;
  for (int i = 1; i < type.value_count(); ++i) {
    names.push_back(type.value(i)->name().substr(prefix));
    for (char& c : names.back()) c = c == '_' ? '-' : static_cast<char>(c - 'A' + 'a');
  }
  return names;
}

std::string join(const std::vector<std::string>& names, std::string_view separator) {
  return fmt::format("{}", fmt::join(names, separator));
}

void set_choice(Message& spec, const FieldDescriptor& field, const std::string& text) {
  const std::vector<std::string> names = choices(*field.enum_type());
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) {
    throw CLI::ValidationError(flag_of(field.name()),
                               "'" + text + "' is unknown. Use " + join(names, " or "));
  }
  const int index = static_cast<int>(found - names.begin()) + 1;
  spec.GetReflection()->SetEnum(&spec, &field, field.enum_type()->value(index));
}

void set_depth(Message& spec, const FieldDescriptor& field, const std::string& text) {
  spec.GetReflection()->ClearField(&spec, &field);
  if (text == "full") return;
  double depth_mm = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, depth_mm);
  if (parsed.ec != std::errc() || parsed.ptr != end) {
    throw CLI::ValidationError(flag_of(field.name()),
                               "'" + text + "' is not a number. Give a depth in mm, or full");
  }
  spec.GetReflection()->SetDouble(&spec, &field, depth_mm);
}

void add_names(Message& spec, const FieldDescriptor& field, const std::vector<std::string>& names) {
  for (const std::string& name : names) spec.GetReflection()->AddString(&spec, &field, name);
}

void set_file(Message& spec, const FieldDescriptor& field, const std::string& path) {
  static_cast<v1::InputFile*>(spec.GetReflection()->MutableMessage(&spec, &field))->set_name(path);
}

void add_numbers(const nlohmann::json& json, const std::string& key,
                 google::protobuf::RepeatedField<double>& numbers) {
  if (!json.contains(key)) return;
  for (const nlohmann::json& number : json[key]) numbers.Add(number.get<double>());
}

}  // namespace

const FieldDescriptor& Flags::field(const std::string& name) const {
  return *spec_.GetDescriptor()->FindFieldByName(name);
}

CLI::Option& Flags::add_text(const std::string& flag, const std::string& description,
                             const std::function<void(const std::string&)>& set) {
  return *app_.add_option_function<std::string>(flag, set, description);
}

CLI::Option& Flags::add_option(const FieldDescriptor& field, const std::string& description) {
  const std::string flag = flag_of(field.name());
  Message* const spec = &spec_;
  const auto* const reflection = spec_.GetReflection();
  const FieldDescriptor* const to = &field;
  if (field.is_repeated()) {
    const auto add = [=](const std::vector<std::string>& names) { add_names(*spec, *to, names); };
    return *app_.add_option_function<std::vector<std::string>>(flag, add, description)
                ->delimiter(',');
  }
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return *app_.add_flag_function(
          flag, [=](std::int64_t count) { reflection->SetBool(spec, to, count > 0); }, description);
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return *app_.add_option_function<double>(
          flag, [=](const double& value) { reflection->SetDouble(spec, to, value); }, description);
    case FieldDescriptor::CPPTYPE_INT32:
      return *app_.add_option_function<std::int32_t>(
          flag, [=](const std::int32_t& value) { reflection->SetInt32(spec, to, value); },
          description);
    case FieldDescriptor::CPPTYPE_ENUM:
      return *add_text(flag, description, [=](const std::string& text) {
                set_choice(*spec, *to, text);
              }).type_name(join(choices(*field.enum_type()), "|"));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return *add_text(flag, description, [=](const std::string& path) {
                set_file(*spec, *to, path);
              }).type_name("FILE");
    default:
      return add_text(flag, description,
                      [=](const std::string& text) { reflection->SetString(spec, to, text); });
  }
}

void Flags::add(const std::string& name, const std::string& description, const FlagHelp& help) {
  CLI::Option& option = add_option(field(name), description);
  if (!help.default_value.empty()) option.default_str(help.default_value);
  if (!help.type.empty()) option.type_name(help.type);
}

void Flags::require(const std::string& name, const std::string& description, const FlagHelp& help) {
  add(name, description, help);
  app_.get_option(flag_of(name))->required();
}

void Flags::add_pose() {
  add_text("--pose",
           R"({"rotation_wxyz":[w,x,y,z],"translation_mm":[x,y,z]}; default: as in the file, )"
           "bounding box centred on the film",
           [this](const std::string& path) { pose_file_ = path; })
      .type_name("FILE.json");
}

void Flags::add_depth() {
  const FieldDescriptor* const to = &field("depth_mm");
  add_text(flag_of(to->name()), "Immersion at the end of the dip, mm",
           [spec = &spec_, to](const std::string& text) { set_depth(*spec, *to, text); })
      .default_str("full")
      ->type_name("D|full");
}

void Flags::require_folders(const std::string& name, const std::string& file,
                            const std::string& description, int most) {
  const FieldDescriptor* const to = &field(name);
  const auto add = [spec = &spec_, to, file](const std::vector<std::string>& folders) {
    for (const std::string& folder : folders) {
      auto* const added = spec->GetReflection()->AddMessage(spec, to);
      static_cast<v1::InputFile*>(added)->set_name(folder + "/" + file);
    }
  };
  app_.add_option_function<std::vector<std::string>>(flag_of(name), add, description)
      ->required()
      ->type_name("DIR")
      ->expected(1, most == 0 ? -1 : most);
}

Status Flags::read_pose() {
  if (pose_file_.empty()) return {};
  HP_ASSIGN_OR_RETURN(const nlohmann::json json, read_json_file(pose_file_));
  HP_RETURN_IF_ERROR(parse_pose(json, pose_file_.string()));
  auto& pose =
      static_cast<v1::Pose&>(*spec_.GetReflection()->MutableMessage(&spec_, &field("pose")));
  add_numbers(json, "rotation_wxyz", *pose.mutable_rotation_wxyz());
  add_numbers(json, "translation_mm", *pose.mutable_translation_mm());
  return {};
}

std::string default_text(double value) { return fmt::format("{}", value); }

}  // namespace hydroprint::worker
