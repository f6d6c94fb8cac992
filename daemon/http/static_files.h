#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/http/protocol/request_parser.h"
#include "daemon/http/protocol/response.h"
#include "sim/base/result.h"

namespace hydroprint::http {

/// The web client's files, read once at the start: a request names an entry of a table and never a
/// place on the disk.
class StaticFiles {
 public:
  /// Reads a folder; without it, there is one page that says how to build the client. "app.js.br"
  /// and "app.js.gz" are "app.js", compressed.
  /// @return kInvalidArgument if it has more than 64 MiB or 10000 files
  [[nodiscard]] static Result<StaticFiles> load(const std::filesystem::path& folder);

  /// The answer to a GET or HEAD of this path; index.html for what may be a page of the client (no
  /// dot in its last part). Status 404 and no body if it is nothing.
  [[nodiscard]] Response answer(const Head& head) const;

 private:
  struct Variant {
    std::shared_ptr<const std::string> content;
    std::string tag;
  };
  struct File {
    std::string type;
    Variant plain, brotli, gzip;
  };
  [[nodiscard]] const File* find(std::string_view path) const;

  std::map<std::string, File, std::less<>> files_;  // by path: "/assets/app-3f.js"
};

}  // namespace hydroprint::http
