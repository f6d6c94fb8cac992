#include "daemon/http/static_files.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>

#include "daemon/http/protocol/byte_range.h"
#include "sim/base/sha256.h"

namespace hydroprint::http {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = 64 << 20;
constexpr std::size_t kMostFiles = 10'000;

constexpr const char* kNoClient =
    "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>Hydroprint</title>\n"
    "<h1>Hydroprint</h1>\n<p>The daemon is running, but its web client was not found. Build it "
    "with <code>deploy/build-web</code> or set its folder in <code>server.web_dir</code>, and "
    "restart the daemon.</p>\n<p>The API is at <a href=\"openapi.json\">"
    "openapi.json</a>.</p>\n</html>\n";

std::string type_of(const fs::path& path) {
  static constexpr std::array<std::pair<std::string_view, const char*>, 17> kTypes{{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".webp", "image/webp"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".wasm", "application/wasm"},
      {".txt", "text/plain; charset=utf-8"},
      {".obj", "model/obj"},
      {".ply", "model/ply"},
  }};
  const std::string extension = path.extension();
  for (const auto& [known, type] : kTypes) {
    if (extension == known) return type;
  }
  return "application/octet-stream";
}

Result<std::string> read_all(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(file), {}};
  if (file.bad() || !file.is_open()) {
    return fail(Code::kPermissionDenied,
                path.string() + ": cannot be read; make the files in server.web_dir readable");
  }
  return content;
}

// Returns whether the client accepts a content coding; "br;q=0" rejects "br".
bool accepts(const Head& head, std::string_view coding) {
  for (const std::string_view one :
       parts_of(head.fields.find("Accept-Encoding").value_or(""), ',')) {
    const std::size_t semicolon = std::min(one.find(';'), one.size());
    if (!same_name(trimmed(one.substr(0, semicolon)), coding)) continue;
    const std::string_view weight = trimmed(one.substr(std::min(semicolon + 1, one.size())));
    return weight.find_first_of("123456789") != std::string_view::npos || weight.empty();
  }
  return false;
}

// Returns a relative URL from a path to the root: "../" for "/jobs/7"; empty for "/jobs".
std::string url_of_root(std::string_view path) {
  std::string out;
  for (auto slashes = std::count(path.begin(), path.end(), '/'); slashes > 1; --slashes) {
    out += "../";
  }
  return out;
}

}  // namespace

Result<StaticFiles> StaticFiles::load(const fs::path& folder) {
  StaticFiles out;
  std::error_code error;
  std::uintmax_t bytes = 0;
  std::size_t count = 0;
  fs::recursive_directory_iterator entries(folder, error);
  for (; !error && entries != fs::recursive_directory_iterator(); entries.increment(error)) {
    if (entries->is_symlink() || !entries->is_regular_file()) continue;
    fs::path path = entries->path();
    HP_ASSIGN_OR_RETURN(auto content, read_all(path));
    bytes += content.size();
    if (bytes > kMostBytes || ++count > kMostFiles) {
      return fail(Code::kInvalidArgument,
                  folder.string() +
                      ": too large for a web client (64 MiB, 10000 files); name "
                      "another folder in server.web_dir",
                  ErrorReason::CONFIG_INVALID);
    }
    const std::string coding = path.extension();
    if (coding == ".br" || coding == ".gz") path.replace_extension();
    File& file = out.files_["/" + path.lexically_relative(folder).generic_string()];
    file.type = type_of(path);
    Variant& variant = coding == ".br" ? file.brotli : coding == ".gz" ? file.gzip : file.plain;
    variant.tag = '"' + sha256(content) + '"';
    variant.content = std::make_shared<const std::string>(std::move(content));
  }
  std::erase_if(out.files_, [](const auto& entry) { return !entry.second.plain.content; });
  if (!out.files_.contains("/index.html")) {
    auto page = std::make_shared<const std::string>(kNoClient);
    out.files_["/index.html"] = {
        "text/html; charset=utf-8", {page, '"' + sha256(*page) + '"'}, {}, {}};
  }
  return out;
}

const StaticFiles::File* StaticFiles::find(std::string_view path) const {
  auto found = files_.find(path);
  const bool has_dot = path.substr(path.rfind('/') + 1).find('.') != std::string_view::npos;
  if (found == files_.end() && !has_dot) found = files_.find("/index.html");
  return found == files_.end() ? nullptr : &found->second;
}

Response StaticFiles::answer(const Head& head) const {
  Response response;
  const std::string_view path = head.path();
  const File* file = path.starts_with('/') ? find(path) : nullptr;
  if (file == nullptr) {
    response.status = 404;
    return response;
  }
  // The page refers to its files by relative URLs, which are wrong in a folder. The redirect is
  // relative too, because a reverse proxy may serve the page in a folder of its own.
  if (const std::string root = url_of_root(path); !root.empty() && !files_.contains(path)) {
    response.status = 302;
    response.fields.set("Location", root);
    return response;
  }
  const Variant* chosen = &file->plain;
  if (file->gzip.content && accepts(head, "gzip")) chosen = &file->gzip;
  if (file->brotli.content && accepts(head, "br")) chosen = &file->brotli;
  if (chosen != &file->plain) {
    response.fields.set("Content-Encoding", chosen == &file->brotli ? "br" : "gzip");
  }
  if (file->gzip.content || file->brotli.content) response.fields.set("Vary", "Accept-Encoding");
  response.fields.set("ETag", chosen->tag);
  // File names in /assets/ contain a hash, so a changed file has a new name.
  const bool is_hashed = path.starts_with("/assets/");
  response.fields.set("Cache-Control",
                      is_hashed ? "public, max-age=31536000, immutable" : "no-cache");
  if (lists_tag(head.fields.find("If-None-Match").value_or(""), chosen->tag)) {
    response.status = 304;
    return response;
  }
  response.fields.set("Content-Type", file->type);
  response.shared_body = chosen->content;
  return response;
}

}  // namespace hydroprint::http
