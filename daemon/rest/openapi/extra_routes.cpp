#include "daemon/rest/openapi/extra_routes.h"

namespace hydroprint::rest {
namespace {

using Parameters = std::vector<OtherParameter>;

OtherParameter in_path(std::string name, std::string description) {
  return {std::move(name), "path", "string", true, std::move(description)};
}

OtherParameter in_header(std::string name, std::string type, std::string description) {
  return {std::move(name), "header", std::move(type), false, std::move(description)};
}

Parameters upload_headers() {
  return {
      in_header("Upload-Offset", "integer", "How many bytes are here: the offset to go on from."),
      in_header("Upload-Length", "integer", "How many bytes there will be.")};
}

OtherRoute upload_state() {
  return {.http_method = "HEAD",
          .path = "/v1/uploads/{upload}",
          .operation = "HeadUpload",
          .tag = "AssetService",
          .summary = "How far an upload got, as headers",
          .description = "GetUpload says the same, and more, as JSON.",
          .parameters = {in_path("upload", "Id of the upload.")},
          .content_type = {},
          .answers = {{204, "It is not complete.", "", "", upload_headers()}}};
}

OtherRoute upload_bytes() {
  OtherParameter offset = in_header("Upload-Offset", "integer",
                                    "Where these bytes go: the number of bytes sent before.");
  offset.required = true;
  return {.http_method = "PATCH",
          .path = "/v1/uploads/{upload}",
          .operation = "PatchUpload",
          .tag = "AssetService",
          .summary = "Sends bytes, in order",
          .description =
              "What was received stays when the connection breaks; ask where to go on with\n"
              "HEAD. With the last byte the hash is checked; only if it is right does the\n"
              "asset exist. Refused as UploadChunk refuses.",
          .parameters = {in_path("upload", "Id of the upload."), std::move(offset)},
          .content_type = "application/octet-stream",
          .answers = {{200,
                       "All bytes are here and their hash is right.",
                       "application/json",
                       "hydroprint.v1.Asset",
                       {upload_headers().front()}},
                      {204, "Some are missing.", "", "", upload_headers()}}};
}

OtherRoute download(const std::string& http_method) {
  const bool has_body = http_method == "GET";
  const std::string type = has_body ? "application/octet-stream" : "";
  const Parameters headers = {
      in_header("ETag", "string", "SHA-256 of the file, in quotes."),
      in_header("Accept-Ranges", "string", "\"bytes\"."),
      in_header("Content-Disposition", "string", "To be kept as a file, by its name.")};
  return {.http_method = http_method,
          .path = "/v1/jobs/{job}/artifacts/{artifact}:download",
          .operation = has_body ? "DownloadArtifact" : "HeadArtifact",
          .tag = "ArtifactService",
          .summary = has_body ? "The bytes of an artifact"
                              : "What a download would answer, without the bytes",
          .description =
              "Content-Type is the artifact's media type. A file never changes, so that a\n"
              "download that broke off can go on with Range. Refused as DownloadArtifact\n"
              "of the gRPC API refuses.",
          .parameters = {in_path("job", "Number of the job."),
                         in_path("artifact", "Name of the file."),
                         in_header("Range", "string", "\"bytes=1000-\": only these bytes."),
                         in_header("If-Range", "string",
                                   "Range holds only for the file with this ETag."),
                         in_header("If-None-Match", "string", "ETag of what is there already."),
                         {"inline", "query", "string", false,
                          "\"1\": to be shown, not kept as a file."}},
          .content_type = {},
          .answers = {{200, "The file.", type, "", headers},
                      {206, "The bytes that were asked for.", type, "", headers},
                      {304, "It is what If-None-Match says.", "", "", {}}}};
}

// What needs no parameter and answers in one way.
OtherRoute plain_get(std::string path, std::string operation, const std::string& summary,
                     std::string description, std::string content_type) {
  return {.http_method = "GET",
          .path = std::move(path),
          .operation = std::move(operation),
          .tag = "Daemon",
          .summary = summary,
          .description = std::move(description),
          .parameters = {},
          .content_type = {},
          .answers = {{200, summary + ".", std::move(content_type), "", {}}},
          .is_open = true};
}

}  // namespace

const std::vector<OtherRoute>& other_routes() {
  static const std::vector<OtherRoute> routes = {
      plain_get("/healthz", "GetHealth", "How the daemon is",
                "503, with the same JSON, if it cannot do its work.", "application/json"),
      plain_get("/metrics", "GetMetrics", "Figures for Prometheus", "", "text/plain"),
      plain_get("/openapi.json", "GetOpenApi", "This document", "", "application/json"),
      download("GET"),
      download("HEAD"),
      upload_state(),
      upload_bytes(),
  };
  return routes;
}

}  // namespace hydroprint::rest
