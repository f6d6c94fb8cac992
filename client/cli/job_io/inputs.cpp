#include "client/cli/job_io/inputs.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <string_view>
#include <utility>

#include "client/cli/job_io/spec_fields.h"
#include "client/cli/terminal/console.h"
#include "client/files/references.h"

namespace hydroprint::cli {

Result<client::Uploaded> upload_shown(client::Connection& connection,
                                      const std::filesystem::path& file) {
  ProgressLine line(STDERR_FILENO);
  return client::upload_file(connection, file, [&](std::int64_t done, std::int64_t total) {
    line.show("uploading " + file.filename().string(),
              static_cast<double>(done) / static_cast<double>(total), format_bytes(total));
  });
}

Status Inputs::add_model(const std::filesystem::path& mesh, google::protobuf::Message& spec) {
  HP_ASSIGN_OR_RETURN(file_in(spec, "mesh"), add_as(mesh.filename().string(), mesh));
  HP_ASSIGN_OR_RETURN(const client::References references, client::find_references(mesh));
  for (const std::string& note : references.notes)
    std::cerr << "hydroprint: note: " << printable(note) << std::endl;
  for (const client::Reference& reference : references.files) {
    HP_ASSIGN_OR_RETURN(file_in(spec, "extra_files"), add_as(reference.name, reference.path));
  }
  return {};
}

Result<v1::InputFile> Inputs::add(const std::filesystem::path& file) {
  std::string name = file.filename().string();
  for (int i = 2; names_.contains(name); ++i)
    name = std::to_string(i) + "-" + file.filename().string();
  return add_as(name, file);
}

Status Inputs::add_to(google::protobuf::Message& spec, const std::string& field,
                      const std::filesystem::path& file) {
  if (file.empty()) return {};
  HP_ASSIGN_OR_RETURN(file_in(spec, field), add(file));
  return {};
}

Result<std::vector<v1::InputFile>> Inputs::add_frames(
    const std::vector<std::filesystem::path>& folders) {
  std::vector<v1::InputFile> out;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    std::error_code error;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folders[i], error)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
    if (error || !std::filesystem::exists(folders[i] / "frames.json")) {
      return fail(Code::kNotFound, folders[i].string() +
                                       ": contains no frames.json; use a folder written by "
                                       "hydroprint-capture or 'hydroprint capture'");
    }
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
      const std::string name = "view" + std::to_string(i + 1) + "/" + file.filename().string();
      HP_ASSIGN_OR_RETURN(out.emplace_back(), add_as(name, file));
    }
  }
  return out;
}

Status Inputs::add_film(const std::string& film, google::protobuf::Message& spec,
                        google::protobuf::Message& with_files) {
  constexpr std::string_view kPolygon = "polygon:";
  if (!film.empty()) set_text(spec, "film", film);
  if (!film.starts_with(kPolygon)) return {};
  const std::string path = film.substr(kPolygon.size());
  if (path.empty())
    return fail(Code::kInvalidArgument, "--film polygon: a file is missing; use polygon:FILE.json");
  HP_ASSIGN_OR_RETURN(const v1::InputFile file, add(path));
  file_in(with_files, "extra_files") = file;
  set_text(spec, "film", std::string(kPolygon) + file.name());
  return {};
}

Result<v1::InputFile> Inputs::add_as(const std::string& name, const std::filesystem::path& file) {
  HP_ASSIGN_OR_RETURN(const client::Uploaded uploaded, upload_shown(connection_, file));
  names_.insert(name);
  v1::InputFile input;
  input.set_name(name);
  input.set_asset(uploaded.asset.name());
  return input;
}

}  // namespace hydroprint::cli
