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

/// The web client's files, read once at startup. A request selects an entry of a table, never a
/// path on the disk.
class StaticFiles {
 public:
  /// Reads a folder. If it has no index.html, that page explains how to build the client.
  /// "app.js.br" and "app.js.gz" are compressed variants of "app.js".
  /// @return kInvalidArgument if the folder has more than 64 MiB or 10000 files
  [[nodiscard]] static Result<StaticFiles> load(const std::filesystem::path& folder);

  /// Returns the response to a GET or HEAD: a file, or index.html for a path that may be a page of
  /// the client (no dot in its last part). Otherwise status 404 without a body.
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

  std::map<std::string, File, std::less<>> files_;  // keyed by path: "/assets/app-3f.js"
};

}  // namespace hydroprint::http
