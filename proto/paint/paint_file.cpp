#include "proto/paint/paint_file.h"

#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/util/json_util.h>

#include <string>

#include "proto/paint/check_paint.h"
#include "sim/base/checked_json.h"
#include "sim/base/input_file.h"

namespace hydroprint::paint {
namespace {

/// Replaces names of pictures by messages: "cat.png" by {"name": "cat.png"}.
void expand_pictures(nlohmann::json& json) {
  if (!json.is_object() || !json.contains("layers") || !json["layers"].is_array()) return;
  for (nlohmann::json& layer : json["layers"]) {
    if (layer.is_object() && layer.contains("picture") && layer["picture"].is_string())
      layer["picture"] = {{"name", layer["picture"]}};
  }
}

Status resolve_pictures(const std::filesystem::path& path, v1::Paint& paint) {
  for (int i = 0; i < paint.layers_size(); ++i) {
    if (!paint.layers(i).has_picture()) continue;
    v1::InputFile& picture = *paint.mutable_layers(i)->mutable_picture();
    const std::string place = path.string() + ": layers[" + std::to_string(i) + "].picture: ";
    if (picture.name().empty())
      return fail(Code::kInvalidArgument, place + "has no name. Name a file");
    const std::string name = (path.parent_path() / picture.name()).string();
    if (const auto opened = open_input_file(name); !opened)
      return fail(opened.error().code, place + opened.error().message);
    if (paint.layers(i).name().empty())
      paint.mutable_layers(i)->set_name(std::filesystem::path(name).filename().string());
    picture.set_name(name);
  }
  return {};
}

}  // namespace

Result<v1::Paint> read_paint_file(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(nlohmann::json json, read_json_file(path));
  expand_pictures(json);
  v1::Paint paint;
  const google::protobuf::LogSilencer silencer;
  const auto parsed = google::protobuf::util::JsonStringToMessage(json.dump(), &paint);
  if (!parsed.ok()) {
    return fail(Code::kInvalidArgument,
                path.string() + ": not a valid Paint: " + std::string(parsed.message()) +
                    ". Write an object with base_colour and layers");
  }
  if (const auto violations = check(paint, ""); !violations.empty()) {
    return fail(Code::kInvalidArgument, path.string() + ": " + violations.front().field + ": " +
                                            violations.front().problem);
  }
  HP_RETURN_IF_ERROR(resolve_pictures(path, paint));
  return paint;
}

}  // namespace hydroprint::paint
