#pragma once

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace hydroprint::http {

/// Returns the method with this name, "/hydroprint.v1.JobService/GetJob"; null if there is none.
[[nodiscard]] inline const google::protobuf::MethodDescriptor* method_called(
    std::string_view method) {
  std::string name(method.substr(std::min<std::size_t>(1, method.size())));
  std::replace(name.begin(), name.end(), '/', '.');
  return google::protobuf::DescriptorPool::generated_pool()->FindMethodByName(name);
}

}  // namespace hydroprint::http
