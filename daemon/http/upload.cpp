// Passes the bytes of an upload from the connection to the asset service.
#include "daemon/http/upload.h"

#include "daemon/http/credentials.h"
#include "daemon/http/error_response.h"
#include "daemon/http/protocol/async_value.h"
#include "daemon/http/protocol/upload_head.h"
#include "daemon/http/rpc_call.h"
#include "hydroprint/v1/asset_service.pb.h"

namespace hydroprint::http {
namespace {

constexpr milliseconds kStorePatience{60'000};  // time allowed for a slow disk
const std::string kUploadChunk = "/hydroprint.v1.AssetService/UploadChunk";
const std::string kGetUpload = "/hydroprint.v1.AssetService/GetUpload";

Response state_of(const v1::Upload& upload) {
  Response response;
  response.status = 204;
  response.fields.set("Upload-Offset", std::to_string(upload.received_bytes()));
  response.fields.set("Upload-Length", std::to_string(upload.size_bytes()));
  return response;
}

/// Passes a request body to the asset service. Each piece is read after the service has received
/// the previous piece.
class Passing {
 public:
  Passing(ServerContext& server, Exchange& exchange, std::string name, std::int64_t offset,
          const InProcessChannel::Metadata& metadata)
      : exchange_(exchange),
        stream_(server.rpc.stream(kUploadChunk, metadata)),
        name_(std::move(name)),
        offset_(offset) {}

  // Returns the call's status, or an Error if the body is incomplete. The store keeps the bytes
  // received before the error.
  Task<Result<Reply>> run() {
    bool is_taken = co_await pass_on({});  // opens the upload, even if no bytes follow
    while (is_taken) {
      Result<std::string> piece = co_await exchange_.read_body_piece();
      if (!piece) co_return tl::unexpected(piece.error());
      if (piece->empty()) break;
      is_taken = co_await pass_on(std::move(*piece));
    }
    co_return co_await finish();
  }

 private:
  Task<bool> pass_on(std::string bytes) {
    v1::UploadChunkRequest chunk;
    chunk.set_upload(name_);
    chunk.set_offset(offset_);
    offset_ += static_cast<std::int64_t>(bytes.size());
    chunk.set_data(std::move(bytes));
    AsyncValue<bool> written(exchange_.shared_socket());
    stream_->write(chunk.SerializeAsString(), false, written.receiver());
    const bool in_time = co_await written.wait(kStorePatience);
    co_return in_time&& written.take();
  }

  Task<Reply> finish() {
    const Reply late{4, "the store did not answer in time", "", ""};
    AsyncValue<std::optional<std::string>> response(exchange_.shared_socket());
    AsyncValue<Reply> async_value(exchange_.shared_socket());
    // This order is required. Within a process, gRPC drops a response that is not being read when
    // the status arrives, and then the call never ends for the store.
    stream_->read(response.receiver());
    stream_->end_writing();
    const bool answered = co_await response.wait(kStorePatience);
    if (!answered) co_return late;
    stream_->finish(async_value.receiver());
    const bool in_time = co_await async_value.wait(kStorePatience);
    if (!in_time) co_return late;
    Reply reply = async_value.take();
    reply.response = response.take().value_or("");
    co_return reply;
  }

  Exchange& exchange_;
  std::unique_ptr<Stream> stream_;
  std::string name_;
  std::int64_t offset_;
};

Task<void> answer_bytes(ServerContext& server, Exchange& exchange, std::string name,
                        InProcessChannel::Metadata metadata) {
  const Result<std::int64_t> offset = upload_offset(exchange.head().fields);
  if (!offset) {
    co_await refuse(exchange, offset.error());
    co_return;
  }
  Passing passing(server, exchange, std::move(name), *offset, metadata);
  const Result<Reply> reply = co_await passing.run();
  if (!reply) {
    const bool is_late = reply.error().reason == ErrorReason::REQUEST_TIMED_OUT;
    std::optional<int> status;
    if (is_late) status = 408;
    co_await refuse(exchange, reply.error(), status);
    co_return;
  }
  v1::UploadChunkResponse result;
  if (!reply->ok() || !result.ParseFromString(reply->response)) {
    co_await exchange.send(refusal(*reply));
  } else if (result.has_upload()) {
    co_await exchange.send(state_of(result.upload()));
  } else {
    Result<std::string> json = server.transcoder.write("/hydroprint.v1.AssetService/GetAsset",
                                                       result.asset().SerializeAsString());
    Response response = json ? json_response(200, std::move(*json)) : refusal(json.error());
    response.fields.set("Upload-Offset", std::to_string(result.asset().size_bytes()));
    co_await exchange.send(std::move(response));
  }
}

Task<void> answer_state(ServerContext& server, Exchange& exchange, std::string name,
                        InProcessChannel::Metadata metadata) {
  v1::GetUploadRequest request;
  request.set_name(name);
  rest::Call get{kGetUpload, false, request.SerializeAsString()};
  const Reply reply = co_await call(server, exchange, std::move(get), std::move(metadata));
  v1::Upload upload;
  if (!reply.ok() || !upload.ParseFromString(reply.response)) {
    co_await exchange.send(refusal(reply));
    co_return;
  }
  co_await exchange.send(state_of(upload));
}

}  // namespace

Task<std::string> answer_upload(ServerContext& server, Exchange& exchange) {
  const Head& head = exchange.head();
  Result<std::string> name = upload_name(head.path());
  Result<InProcessChannel::Metadata> metadata =
      admit(server, exchange, head.method == "HEAD" ? kGetUpload : kUploadChunk);
  if (!name || !metadata) {
    const Error& error = metadata ? name.error() : metadata.error();
    co_await refuse(exchange, error);
    co_return "refused";
  }
  if (head.method == "HEAD") {
    co_await answer_state(server, exchange, std::move(*name), std::move(*metadata));
    co_return "upload state";
  }
  co_await answer_bytes(server, exchange, std::move(*name), std::move(*metadata));
  co_return "upload";
}

}  // namespace hydroprint::http
