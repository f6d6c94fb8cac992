#include "daemon/rpc/grpc_status.h"

namespace hydroprint::daemon {

grpc::Status to_grpc(const Error& error) {
  return {static_cast<grpc::StatusCode>(number_of(error.code)), full_message(error),
          rest::status_details(error)};
}

grpc::Status to_grpc(const Status& status) {
  return status ? grpc::Status::OK : to_grpc(status.error());
}

}  // namespace hydroprint::daemon
