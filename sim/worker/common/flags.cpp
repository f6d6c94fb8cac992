#include "sim/worker/common/flags.h"

#include <fmt/format.h>
#include <google/protobuf/message.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "hydroprint/v1/field_rules.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/flags/field_flag.h"
#include "proto/rules/field_rules.h"
#include "sim/base/checked_json.h"
#include "sim/base/pose_file.h"
#include "sim/worker/common/fields.h"

namespace hydroprint::worker {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

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

void Flags::add_file(const FieldDescriptor& field) {
  const bool is_pose = field.message_type() == v1::Pose::descriptor();
  const auto take = [this, &field, is_pose](const std::string& path) {
    is_pose ? static_cast<void>(pose_file_ = path) : set_file(spec_, field, path);
  };
  app_.add_option_function<std::string>(flags::flag_of(field), take, rules::flag_help(field))
      ->type_name("FILE");
}

void Flags::add_field(const FieldDescriptor& field) {
  if (field.message_type() == nullptr) {
    flags::add_field(app_, spec_, field);
  } else {
    add_file(field);
  }
  const v1::FieldRules* const rules = rules::rules_of(field);
  if (rules != nullptr && rules->required()) require(field.name());
}

void Flags::add_fields(const std::vector<std::string>& only) {
  const auto& type = *spec_.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    const bool is_list_of_files = field.is_repeated() && field.message_type() != nullptr;
    if (is_list_of_files || is_reference(field) || field.name() == "threads") continue;
    const bool is_wanted =
        only.empty() || std::find(only.begin(), only.end(), field.name()) != only.end();
    if (is_wanted) add_field(field);
  }
}

void Flags::require(const std::string& name) {
  app_.get_option(flags::flag_of(field(name)))->required();
}

void Flags::require_folders(const std::string& name, const std::string& file) {
  const FieldDescriptor& to = field(name);
  const auto add = [this, &to, file](const std::vector<std::string>& folders) {
    for (const std::string& folder : folders) {
      auto* const added = spec_.GetReflection()->AddMessage(&spec_, &to);
      static_cast<v1::InputFile*>(added)->set_name(folder + "/" + file);
    }
  };
  app_.add_option_function<std::vector<std::string>>(flags::flag_of(to), add, rules::flag_help(to))
      ->required()
      ->type_name("DIR");
}

Status Flags::read_pose() {
  if (pose_file_.empty()) return {};
  HP_ASSIGN_OR_RETURN(const nlohmann::json json, read_json_file(pose_file_));
  HP_ASSIGN_OR_RETURN(const PoseFile file, parse_pose(json, pose_file_.string()));
  auto& pose =
      static_cast<v1::Pose&>(*spec_.GetReflection()->MutableMessage(&spec_, &field("pose")));
  add_numbers(json, "rotation_wxyz", *pose.mutable_rotation_wxyz());
  add_numbers(json, "translation_mm", *pose.mutable_translation_mm());
  set_uncertainty(file.uncertainty, pose);
  return {};
}

void add_field_flags(Flags& flags) { flags.add_fields(); }

}  // namespace hydroprint::worker
