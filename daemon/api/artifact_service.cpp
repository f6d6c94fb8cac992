#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "daemon/api/services.h"
#include "daemon/auth/visibility.h"
#include "daemon/platform/resource_names.h"
#include "daemon/rpc/caller_metadata.h"
#include "daemon/rpc/grpc_status.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/artifact_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kChunk = 64 << 10;

class ArtifactService final : public v1::ArtifactService::Service {
 public:
  explicit ArtifactService(const ServiceContext& backend) : backend_(backend) {}

  grpc::Status ListArtifacts(grpc::ServerContext* context, const v1::ListArtifactsRequest* request,
                             v1::ListArtifactsResponse* reply) override {
    return to_grpc(list(*context, *request, *reply));
  }

  grpc::Status GetArtifact(grpc::ServerContext* context, const v1::GetArtifactRequest* request,
                           v1::Artifact* reply) override {
    return to_grpc(get(*context, *request, *reply));
  }

  grpc::Status DownloadArtifact(grpc::ServerContext* context,
                                const v1::DownloadArtifactRequest* request,
                                grpc::ServerWriter<v1::DownloadArtifactResponse>* writer) override {
    return to_grpc(download(*context, *request, *writer));
  }

 private:
  Status check_sight(const grpc::ServerContext& context, std::int64_t id) {
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
    HP_ASSIGN_OR_RETURN(const Job job, backend_.jobs.get(id));
    return check_may_see(caller, job);
  }

  Status list(const grpc::ServerContext& context, const v1::ListArtifactsRequest& request,
              v1::ListArtifactsResponse& reply) {
    HP_ASSIGN_OR_RETURN(const std::int64_t job, parse_job_name(request.parent()));
    HP_RETURN_IF_ERROR(check_sight(context, job));
    HP_ASSIGN_OR_RETURN(const int size, page_size(request.page_size(), 50));
    const std::string& token = request.page_token();
    if (!token.empty() && !check_file_name("page_token", token)) return bad_page_token();
    HP_ASSIGN_OR_RETURN(auto artifacts, backend_.jobs.artifacts(job, token, size + 1));
    if (cut_page(artifacts, size)) reply.set_next_page_token(artifacts.back().name);
    for (const Artifact& artifact : artifacts) {
      *reply.add_artifacts() = to_message(job, artifact);
    }
    return {};
  }

  Status get(const grpc::ServerContext& context, const v1::GetArtifactRequest& request,
             v1::Artifact& reply) {
    HP_ASSIGN_OR_RETURN(const auto name, parse_artifact_name(request.name()));
    HP_RETURN_IF_ERROR(check_sight(context, name.first));
    HP_ASSIGN_OR_RETURN(const auto artifact, backend_.jobs.artifact(name.first, name.second));
    reply = to_message(name.first, artifact);
    return {};
  }

  Status download(const grpc::ServerContext& context, const v1::DownloadArtifactRequest& request,
                  grpc::ServerWriter<v1::DownloadArtifactResponse>& writer) {
    HP_ASSIGN_OR_RETURN(const auto name, parse_artifact_name(request.name()));
    HP_RETURN_IF_ERROR(check_sight(context, name.first));
    HP_ASSIGN_OR_RETURN(const auto artifact, backend_.jobs.artifact(name.first, name.second));
    if (request.offset() < 0 || request.offset() > artifact.size_bytes) {
      auto error =
          fail(Code::kOutOfRange,
               fmt::format("offset: must be from 0 to {}, the size of the artifact in bytes",
                           artifact.size_bytes),
               ErrorReason::OFFSET_MISMATCH);
      error.value().metadata["expected_offset"] = std::to_string(artifact.size_bytes);
      return error;
    }
    // The whole file is checked before the first byte is sent, so that no client gets bytes of a
    // damaged file, and so that a part is as good as the whole.
    HP_RETURN_IF_ERROR(backend_.jobs.sound_artifact(name.first, name.second,
                                                    [&] { return context.IsCancelled(); }));
    const auto path = backend_.layout.artifacts(name.first) / name.second;
    HP_ASSIGN_OR_RETURN(const UniqueFd file, open_file(path, O_RDONLY));
    return send(request, file, artifact.size_bytes, writer);
  }

  static tl::unexpected<Error> damaged(const std::string& name) {
    return fail(Code::kDataLoss,
                name + ": the file became shorter or unreadable; download it again",
                ErrorReason::ARTIFACT_DAMAGED);
  }

  static Status send(const v1::DownloadArtifactRequest& request, const UniqueFd& file,
                     std::int64_t size, grpc::ServerWriter<v1::DownloadArtifactResponse>& writer) {
    v1::DownloadArtifactResponse chunk;
    std::int64_t offset = request.offset();
    do {
      std::string& data = *chunk.mutable_data();
      data.resize(kChunk);
      const ssize_t count = ::pread(file.get(), data.data(), data.size(), offset);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0 || (count == 0 && offset < size)) return damaged(request.name());
      data.resize(static_cast<std::size_t>(count));
      chunk.set_offset(offset);
      offset += count;
      if (!writer.Write(chunk)) return fail(Code::kCancelled, "the client disconnected");
    } while (offset < size);
    return {};
  }

  ServiceContext backend_;
};

}  // namespace

std::unique_ptr<grpc::Service> make_artifact_service(const ServiceContext& backend) {
  return std::make_unique<ArtifactService>(backend);
}

}  // namespace hydroprint::daemon
