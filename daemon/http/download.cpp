// Sends the bytes of an artifact as fast as the client reads them.
#include "daemon/http/download.h"

#include <fmt/format.h>

#include "daemon/http/credentials.h"
#include "daemon/http/error_response.h"
#include "daemon/http/protocol/async_value.h"
#include "daemon/http/protocol/byte_range.h"
#include "daemon/http/rpc_call.h"
#include "hydroprint/v1/artifact_service.pb.h"

namespace hydroprint::http {
namespace {

constexpr milliseconds kDiskPatience{60'000};
// The service reads the whole file to check it before it sends the first piece.
constexpr milliseconds kCheckPatience{600'000};
const std::string kGetArtifact = "/hydroprint.v1.ArtifactService/GetArtifact";
const std::string kDownload = "/hydroprint.v1.ArtifactService/DownloadArtifact";

Result<v1::Artifact> artifact_of(const Reply& reply) {
  v1::Artifact artifact;
  if (artifact.ParseFromString(reply.response)) return artifact;
  return fail(Code::kInternal, "the daemon's response cannot be parsed");
}

// The response headers and the range that a request asks for.
struct DownloadPlan {
  ByteRange range;
  Response response;
};

DownloadPlan plan_download(const Head& head, const v1::Artifact& artifact, bool is_inline) {
  DownloadPlan out;
  const std::string tag = '"' + artifact.sha256() + '"';
  const std::string file = artifact.name().substr(artifact.name().rfind('/') + 1);
  const bool is_shown = is_inline && may_be_shown(artifact.media_type());
  HeaderFields& fields = out.response.fields;
  fields.set("ETag", tag);
  fields.set("Cache-Control", "private, no-cache");
  fields.set("Accept-Ranges", "bytes");
  if (lists_tag(head.fields.find("If-None-Match").value_or(""), tag)) {
    out.response.status = 304;
    return out;
  }
  const bool is_same = head.fields.find("If-Range").value_or(tag) == tag;
  const std::string_view range = is_same ? head.fields.find("Range").value_or("") : "";
  const auto size = artifact.size_bytes();
  out.range = byte_range(range, size);
  if (out.range.kind == ByteRange::Kind::kNone) {
    out.response = refusal(
        {Code::kOutOfRange,
         fmt::format("the artifact has {} bytes; the requested range contains none of them", size),
         ErrorReason::RANGE_UNSATISFIABLE,
         {}},
        416);
    out.response.fields.set("Content-Range", fmt::format("bytes */{}", size));
    return out;
  }
  fields.set("Content-Type", artifact.media_type());
  fields.set("Content-Disposition", content_disposition(is_shown, file));
  if (out.range.kind == ByteRange::Kind::kPart) {
    out.response.status = 206;
    fields.set("Content-Range",
               fmt::format("bytes {}-{}/{}", out.range.begin, out.range.end - 1, size));
  }
  return out;
}

/// One download. Each piece is requested after the previous piece was sent.
class Download {
 public:
  Download(ServerContext& server, Exchange& exchange, const InProcessChannel::Metadata& metadata)
      : exchange_(exchange), stream_(server.rpc.stream(kDownload, metadata)) {}

  Task<void> run(const std::string& name, DownloadPlan plan) {
    v1::DownloadArtifactRequest request;
    request.set_name(name);
    request.set_offset(plan.range.begin);
    AsyncValue<bool> written(exchange_.shared_socket());
    stream_->write(request.SerializeAsString(), true, written.receiver());
    co_await written.wait(kDiskPatience);

    std::int64_t left = plan.range.end - plan.range.begin;
    std::optional<std::string> piece = co_await next(kCheckPatience);
    if (!piece) {
      co_await refuse_all();
      co_return;
    }
    bool is_open = co_await exchange_.begin_answer(std::move(plan.response), left);
    while (is_open && left > 0 && piece) {
      if (static_cast<std::int64_t>(piece->size()) > left) {
        piece->resize(static_cast<std::size_t>(left));
      }
      left -= static_cast<std::int64_t>(piece->size());
      is_open = co_await exchange_.write(std::move(*piece));
      if (is_open && left > 0) piece = co_await next(kDiskPatience);
    }
    if (left > 0) exchange_.break_off();
  }

 private:
  // Reads the next piece; nullopt if the call has ended or the store does not answer in time.
  Task<std::optional<std::string>> next(milliseconds patience) {
    AsyncValue<std::optional<std::string>> async_value(exchange_.shared_socket());
    stream_->read(async_value.receiver());
    const bool in_time = co_await async_value.wait(patience);
    v1::DownloadArtifactResponse message;
    std::optional<std::string> bytes;
    if (in_time) bytes = async_value.take();
    if (!bytes || !message.ParseFromString(*bytes)) co_return std::nullopt;
    co_return std::move(*message.mutable_data());
  }

  Task<void> refuse_all() {
    AsyncValue<Reply> async_value(exchange_.shared_socket());
    stream_->cancel();
    stream_->finish(async_value.receiver());
    const bool in_time = co_await async_value.wait(kDiskPatience);
    const Reply reply =
        in_time ? async_value.take() : Reply{4, "the store did not answer in time", "", ""};
    co_await exchange_.send(refusal(reply));
  }

  Exchange& exchange_;
  std::unique_ptr<Stream> stream_;
};

// Returns the response to methods other than GET and HEAD. A browser must not mistake it for the
// file.
Response only_get() {
  Response response = refusal({Code::kUnimplemented,
                               "artifacts are read-only; use GET or HEAD",
                               ErrorReason::METHOD_NOT_ALLOWED,
                               {}},
                              405);
  response.fields.set("Allow", "GET, HEAD, OPTIONS");
  return response;
}

}  // namespace

Task<std::string> answer_download(ServerContext& server, Exchange& exchange, ArtifactPath target) {
  const std::string route = "download";
  const Head& head = exchange.head();
  if (head.method != "GET" && head.method != "HEAD") {
    co_await exchange.send(only_get());
    co_return route;
  }
  const auto metadata = admit(server, exchange, kDownload);
  if (!metadata || !target.is_good) {
    Error error{
        Code::kInvalidArgument,
        "the path or query of this download is not valid; the only allowed query is inline=1",
        ErrorReason::PARAMETER_INVALID,
        {}};
    if (!metadata) error = metadata.error();
    co_await refuse(exchange, std::move(error));
    co_return route;
  }
  v1::GetArtifactRequest request;
  request.set_name(target.name);
  rest::Call get{kGetArtifact, false, request.SerializeAsString()};
  const Reply reply = co_await call(server, exchange, std::move(get), *metadata);
  const Result<v1::Artifact> artifact = artifact_of(reply);
  if (!reply.ok() || !artifact) {
    Response refused = refusal(reply);
    if (reply.ok()) refused = refusal(artifact.error());
    co_await exchange.send(std::move(refused));
    co_return route;
  }
  DownloadPlan plan = plan_download(head, *artifact, target.is_inline);
  const bool has_bytes = plan.response.status == 200 || plan.response.status == 206;
  if (head.method == "HEAD" && has_bytes) {
    const std::int64_t length = plan.range.end - plan.range.begin;
    co_await exchange.begin_answer(std::move(plan.response), length);
  } else if (!has_bytes) {
    co_await exchange.send(std::move(plan.response));
  } else {
    Download download(server, exchange, *metadata);
    co_await download.run(target.name, std::move(plan));
  }
  co_return route;
}

}  // namespace hydroprint::http
