#include "daemon/api/services.h"
#include "daemon/auth/visibility.h"
#include "daemon/jobs/field_check.h"
#include "daemon/platform/log.h"
#include "daemon/platform/resource_names.h"
#include "daemon/rpc/caller_metadata.h"
#include "daemon/rpc/grpc_status.h"
#include "daemon/store/assets/upload_writer.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/asset_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

template <class Reply>
void set_result(const AssetOrUpload& result, Reply& reply) {
  if (const Asset* asset = std::get_if<Asset>(&result)) {
    *reply.mutable_asset() = to_message(*asset);
  } else {
    *reply.mutable_upload() = to_message(std::get<Upload>(result));
  }
}

class AssetService final : public v1::AssetService::Service {
 public:
  explicit AssetService(const ServiceContext& backend) : backend_(backend) {}

  grpc::Status StartUpload(grpc::ServerContext* context, const v1::StartUploadRequest* request,
                           v1::StartUploadResponse* reply) override {
    const auto result = start(*context, *request);
    if (!result) return to_grpc(result.error());
    set_result(*result, *reply);
    return grpc::Status::OK;
  }

  grpc::Status GetUpload(grpc::ServerContext* context, const v1::GetUploadRequest* request,
                         v1::Upload* reply) override {
    const auto upload = find_upload(*context, *request);
    if (!upload) return to_grpc(upload.error());
    *reply = to_message(*upload);
    return grpc::Status::OK;
  }

  grpc::Status UploadChunk(grpc::ServerContext* context,
                           grpc::ServerReader<v1::UploadChunkRequest>* reader,
                           v1::UploadChunkResponse* reply) override {
    const auto result = receive(*context, *reader);
    if (!result) return to_grpc(result.error());
    set_result(*result, *reply);
    return grpc::Status::OK;
  }

  grpc::Status GetAsset(grpc::ServerContext* context, const v1::GetAssetRequest* request,
                        v1::Asset* reply) override {
    const auto asset = get(*context, *request);
    if (!asset) return to_grpc(asset.error());
    *reply = to_message(*asset);
    return grpc::Status::OK;
  }

  grpc::Status ListAssets(grpc::ServerContext* context, const v1::ListAssetsRequest* request,
                          v1::ListAssetsResponse* reply) override {
    return to_grpc(list(*context, *request, *reply));
  }

  grpc::Status DeleteAsset(grpc::ServerContext* context, const v1::DeleteAssetRequest* request,
                           google::protobuf::Empty*) override {
    return to_grpc(remove(*context, *request));
  }

 private:
  Result<AssetOrUpload> start(const grpc::ServerContext& context,
                              const v1::StartUploadRequest& request) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    HP_RETURN_IF_ERROR(check_fields(request));
    HP_ASSIGN_OR_RETURN(const std::string hash, parse_asset_name("assets/" + request.sha256()));
    HP_ASSIGN_OR_RETURN(const AssetUser user, user_of(context));
    const Upload wanted{"", hash, request.size_bytes(), 0, request.media_type(), 0};
    return backend_.uploads.start(wanted, user, request_key("StartUpload", request));
  }

  Result<AssetUser> user_of(const grpc::ServerContext& context) const {
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
    return asset_user(caller);
  }

  Result<Upload> find_upload(const grpc::ServerContext& context,
                             const v1::GetUploadRequest& request) {
    HP_ASSIGN_OR_RETURN(const std::string id, parse_upload_name(request.name()));
    HP_ASSIGN_OR_RETURN(const AssetUser user, user_of(context));
    return backend_.uploads.get(id, user.name);
  }

  Result<Asset> get(const grpc::ServerContext& context, const v1::GetAssetRequest& request) {
    HP_ASSIGN_OR_RETURN(const std::string hash, parse_asset_name(request.name()));
    HP_ASSIGN_OR_RETURN(const AssetUser user, user_of(context));
    return backend_.assets.asset_for(hash, user);
  }

  Status remove(const grpc::ServerContext& context, const v1::DeleteAssetRequest& request) {
    HP_ASSIGN_OR_RETURN(const std::string hash, parse_asset_name(request.name()));
    HP_ASSIGN_OR_RETURN(const AssetUser user, user_of(context));
    return backend_.assets.remove(hash, user);
  }

  Result<AssetOrUpload> receive(const grpc::ServerContext& context,
                                grpc::ServerReader<v1::UploadChunkRequest>& reader) {
    HP_ASSIGN_OR_RETURN(const AssetUser user, user_of(context));
    v1::UploadChunkRequest chunk;
    if (!reader.Read(&chunk))
      return invalid_field(
          "upload", "is missing, because the stream has no messages; send at least one message");
    HP_ASSIGN_OR_RETURN(const std::string id, parse_upload_name(chunk.upload()));
    HP_ASSIGN_OR_RETURN(const auto writer, UploadWriter::open(backend_.uploads, id, user.name));
    do {
      HP_RETURN_IF_ERROR(check_fields(chunk));
      if (!chunk.upload().empty() && chunk.upload() != "uploads/" + id) {
        return invalid_field("upload", "changed within one call; use one call per upload");
      }
      HP_RETURN_IF_ERROR(writer->append(chunk.offset(), chunk.data()));
    } while (reader.Read(&chunk));
    HP_ASSIGN_OR_RETURN(AssetOrUpload result, writer->finish());
    if (const Asset* asset = std::get_if<Asset>(&result)) {
      log(LogLevel::kInfo, "asset_stored",
          {{"asset", asset->sha256}, {"bytes", asset->size_bytes}, {"owner", user.name}});
    }
    return result;
  }

  Status list(const grpc::ServerContext& context, const v1::ListAssetsRequest& request,
              v1::ListAssetsResponse& reply) {
    HP_ASSIGN_OR_RETURN(const AssetUser user, user_of(context));
    HP_ASSIGN_OR_RETURN(const int size, page_size(request.page_size(), 50));
    if (!request.page_token().empty() && !is_sha256(request.page_token())) return bad_page_token();
    const std::string& owner = user.is_operator ? request.owner() : user.name;
    HP_ASSIGN_OR_RETURN(auto assets, backend_.assets.list(request.page_token(), size + 1, owner));
    if (cut_page(assets, size)) reply.set_next_page_token(assets.back().sha256);
    for (Asset& asset : assets) {
      if (!user.is_operator) asset.owners = {user.name};
      *reply.add_assets() = to_message(asset);
    }
    return {};
  }

  ServiceContext backend_;
};

}  // namespace

std::unique_ptr<grpc::Service> make_asset_service(const ServiceContext& backend) {
  return std::make_unique<AssetService>(backend);
}

}  // namespace hydroprint::daemon
