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
  return {in_header("Upload-Offset", "integer",
                    "Number of bytes received: the offset to continue from."),
          in_header("Upload-Length", "integer", "Total number of bytes.")};
}

OtherRoute upload_state() {
  return {.http_method = "HEAD",
          .path = "/v1/uploads/{upload}",
          .operation = "HeadUpload",
          .tag = "AssetService",
          .summary = "Progress of an upload, as headers",
          .description = "GetUpload returns this information and more, as JSON.",
          .parameters = {in_path("upload", "Id of the upload.")},
          .content_type = {},
          .answers = {{204, "The upload is not complete.", "", "", upload_headers()}}};
}

OtherRoute upload_bytes() {
  OtherParameter offset = in_header("Upload-Offset", "integer",
                                    "Offset of these bytes: the number of bytes sent before.");
  offset.required = true;
  return {.http_method = "PATCH",
          .path = "/v1/uploads/{upload}",
          .operation = "PatchUpload",
          .tag = "AssetService",
          .summary = "Sends bytes, in order",
          .description =
              "Bytes received before the connection breaks are kept; HEAD returns the offset\n"
              "at which to continue. After the last byte the hash is checked; the asset exists\n"
              "only if it matches. Fails with the same errors as UploadChunk.",
          .parameters = {in_path("upload", "Id of the upload."), std::move(offset)},
          .content_type = "application/octet-stream",
          .answers = {{200,
                       "All bytes were received and their hash matches.",
                       "application/json",
                       "hydroprint.v1.Asset",
                       {upload_headers().front()}},
                      {204, "Some bytes are missing.", "", "", upload_headers()}}};
}

OtherRoute download(const std::string& http_method) {
  const bool has_body = http_method == "GET";
  const std::string type = has_body ? "application/octet-stream" : "";
  const Parameters headers = {
      in_header("ETag", "string", "SHA-256 of the file, in quotes."),
      in_header("Accept-Ranges", "string", "\"bytes\"."),
      in_header("Content-Disposition", "string", "Attachment with the file's name, or inline.")};
  return {
      .http_method = http_method,
      .path = "/v1/jobs/{job}/artifacts/{artifact}:download",
      .operation = has_body ? "DownloadArtifact" : "HeadArtifact",
      .tag = "ArtifactService",
      .summary = has_body ? "Downloads an artifact" : "Headers of a download, without the bytes",
      .description =
          "Content-Type is the artifact's media type. A file never changes, so a\n"
          "broken download can be resumed with Range. Fails with the same errors as\n"
          "DownloadArtifact of the gRPC API.",
      .parameters = {in_path("job", "Number of the job."),
                     in_path("artifact", "Name of the file."),
                     in_header("Range", "string", "\"bytes=1000-\": only these bytes."),
                     in_header("If-Range", "string",
                               "Range applies only if the file has this ETag."),
                     in_header("If-None-Match", "string", "ETag of the copy that the client has."),
                     {"inline", "query", "string", false,
                      "\"1\": browsers display the file instead of saving it."}},
      .content_type = {},
      .answers = {{200, "The file.", type, "", headers},
                  {206, "The requested bytes.", type, "", headers},
                  {304, "The file has the ETag in If-None-Match.", "", "", {}}}};
}

// Returns a route without parameters and with one kind of response.
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
      plain_get("/healthz", "GetHealth", "Health of the daemon",
                "503, with the same JSON, if the daemon cannot do its work.", "application/json"),
      plain_get("/metrics", "GetMetrics", "Metrics for Prometheus", "", "text/plain"),
      plain_get("/openapi.json", "GetOpenApi", "This document", "", "application/json"),
      download("GET"),
      download("HEAD"),
      upload_state(),
      upload_bytes(),
  };
  return routes;
}

}  // namespace hydroprint::rest
