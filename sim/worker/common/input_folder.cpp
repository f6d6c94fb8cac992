#include "sim/worker/common/input_folder.h"

#include <utility>

#include "hydroprint/v1/spec.pb.h"
#include "sim/film/outline.h"
#include "sim/worker/common/fields.h"

namespace hydroprint::worker {

InputFolder::InputFolder(const std::filesystem::path& folder, std::filesystem::path pose_file)
    : folder_(folder == "." ? std::filesystem::path() : folder), pose_file_(std::move(pose_file)) {}

std::filesystem::path InputFolder::resolve(const std::string& name) const { return folder_ / name; }

std::filesystem::path InputFolder::path(const v1::InputFile& file) const {
  return file.name().empty() ? std::filesystem::path() : resolve(file.name());
}

Result<std::filesystem::path> InputFolder::required(const std::string& field,
                                                    const v1::InputFile& file) const {
  if (!file.name().empty()) return path(file);
  return fail_field(Code::kInvalidArgument, field, "missing. Name a file");
}

Result<std::string> InputFolder::film(const std::string& text) const {
  if (const auto polygon = film::polygon_file(text)) {
    return "polygon:" + resolve(polygon->string()).string();
  }
  const auto outline = film::parse_outline(text);
  if (!outline) return fail_field(outline.error().code, "film", outline.error().message);
  return text;
}

}  // namespace hydroprint::worker
