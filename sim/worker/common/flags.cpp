#include "sim/worker/common/flags.h"

#include <google/protobuf/message.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "hydroprint/v1/field_rules.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/flags/field_flag.h"
#include "proto/paint/paint_file.h"
#include "proto/rules/field_rules.h"
#include "sim/base/immersions_file.h"
#include "sim/worker/common/fields.h"

namespace hydroprint::worker {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

void set_file(Message& spec, const FieldDescriptor& field, const std::string& path) {
  static_cast<v1::InputFile*>(spec.GetReflection()->MutableMessage(&spec, &field))->set_name(path);
}

bool is_pose(const FieldDescriptor& field) {
  return field.message_type() == v1::Pose::descriptor();
}

bool is_list_of_dips(const FieldDescriptor& field) {
  return field.is_repeated() && field.message_type() == v1::DipSetup::descriptor();
}

bool is_paint(const FieldDescriptor& field) {
  return field.message_type() == v1::Paint::descriptor();
}

/// Returns whether the worker has a flag for a field.
bool has_flag(const FieldDescriptor& field) {
  const bool is_list_of_files = field.is_repeated() && field.message_type() != nullptr;
  if (is_list_of_files && !is_list_of_dips(field)) return false;
  return !is_reference(field) && field.name() != "threads";
}

}  // namespace

const FieldDescriptor& Flags::field(const std::string& name) const {
  return *spec_.GetDescriptor()->FindFieldByName(name);
}

void Flags::add_file(const FieldDescriptor& field) {
  const bool holds_poses = is_pose(field) || is_list_of_dips(field);
  const auto take = [this, &field, holds_poses](const std::string& path) {
    if (holds_poses) {
      pose_file_ = path;
    } else if (is_paint(field)) {
      paint_file_ = path;
      Message& holder = flags::holder_of(spec_, field);
      paint_ = holder.GetReflection()->MutableMessage(&holder, &field);
    } else {
      set_file(flags::holder_of(spec_, field), field, path);
    }
  };
  app_.add_option_function<std::string>(flags::flag_of(field), take, rules::flag_help(field))
      ->type_name("FILE");
}

void Flags::add_field(const FieldDescriptor& field) {
  if (field.message_type() == nullptr) {
    flags::add_field(app_, flags::holder_of(spec_, field), field);
  } else {
    add_file(field);
  }
  const v1::FieldRules* const rules = rules::rules_of(field);
  if (rules != nullptr && rules->required()) require(field);
}

void Flags::add_fields(const std::vector<std::string>& only) {
  for (const FieldDescriptor* field : flags::fields_of(*spec_.GetDescriptor())) {
    const bool is_wanted =
        only.empty() || std::find(only.begin(), only.end(), field->name()) != only.end();
    if (is_wanted && has_flag(*field)) add_field(*field);
  }
}

void Flags::require(const std::string& name) { require(field(name)); }

void Flags::require(const FieldDescriptor& field) {
  app_.get_option(flags::flag_of(field))->required();
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

void Flags::add_folder(const std::string& name, const std::vector<std::string>& files) {
  const FieldDescriptor& to = field(name);
  const auto add = [this, &to, files](const std::string& folder) {
    for (const std::string& file : files) {
      auto* const added = spec_.GetReflection()->AddMessage(&spec_, &to);
      static_cast<v1::InputFile*>(added)->set_name(folder + "/" + file);
    }
  };
  app_.add_option_function<std::string>(flags::flag_of(to), add, rules::flag_help(to))
      ->type_name("DIR");
}

Status Flags::read_files() {
  if (paint_ != nullptr) {
    HP_ASSIGN_OR_RETURN(const v1::Paint paint, paint::read_paint_file(paint_file_));
    paint_->CopyFrom(paint);
  }
  return read_poses();
}

Status Flags::read_poses() {
  if (pose_file_.empty()) return {};
  const google::protobuf::Reflection& reflection = *spec_.GetReflection();
  const FieldDescriptor* const dips = spec_.GetDescriptor()->FindFieldByName("immersions");
  if (dips != nullptr) {
    HP_ASSIGN_OR_RETURN(const auto listed, read_immersions_file(pose_file_));
    for (const ListedDip& dip : listed)
      set_dip(dip, static_cast<v1::DipSetup&>(*reflection.AddMessage(&spec_, dips)));
    return {};
  }
  HP_ASSIGN_OR_RETURN(const PoseFile file, read_pose_file(pose_file_));
  set_pose(file, static_cast<v1::Pose&>(*reflection.MutableMessage(&spec_, &field("pose"))));
  return {};
}

void add_field_flags(Flags& flags) { flags.add_fields(); }

}  // namespace hydroprint::worker
