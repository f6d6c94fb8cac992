// What the services are told of who calls.
#include <algorithm>

#include "daemon/http/site.h"

namespace hydroprint::http {
namespace {

// gRPC ends the program at other bytes.
bool is_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c < 0x7f; });
}

}  // namespace

std::optional<std::string_view> cookie(const Fields& fields, std::string_view name) {
  for (const Field& field : fields.all()) {
    if (!same_name(field.name, "Cookie")) continue;
    for (const std::string_view pair : parts_of(field.value, ';')) {
      const std::size_t equals = pair.find('=');
      if (equals != std::string_view::npos && pair.substr(0, equals) == name) {
        return pair.substr(equals + 1);
      }
    }
  }
  return {};
}

Result<Rpc::Metadata> metadata_of(const Head& head, const std::string& peer) {
  Rpc::Metadata metadata{{"hydroprint-peer", peer}};
  const auto add = [&](const char* name, std::optional<std::string_view> value) -> Status {
    if (!value) return {};
    if (!is_printable(*value)) {
      auto error = fail(Code::kInvalidArgument, std::string(name) + ": must be printable ASCII",
                        "SPEC_INVALID");
      error.value().metadata["field"] = name;
      return error;
    }
    metadata.emplace_back(name, *value);
    return {};
  };
  HP_RETURN_IF_ERROR(add("authorization", head.fields.find("Authorization")));
  HP_RETURN_IF_ERROR(add("hydroprint-owner", head.fields.find("Hydroprint-Owner")));
  HP_RETURN_IF_ERROR(add("hydroprint-session", cookie(head.fields, kSessionCookie)));
  return metadata;
}

}  // namespace hydroprint::http
