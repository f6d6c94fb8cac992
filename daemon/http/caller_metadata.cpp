// Metadata that identifies the caller to the services.
#include "daemon/http/caller_metadata.h"

#include <algorithm>

#include "daemon/http/session_cookie.h"

namespace hydroprint::http {
namespace {

// gRPC aborts the program on other bytes.
bool is_printable(char c) { return c >= ' ' && c < 0x7f; }

bool is_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return is_printable(c); });
}

}  // namespace

std::optional<std::string_view> cookie(const HeaderFields& fields, std::string_view name) {
  for (const HeaderField& field : fields.all()) {
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

Result<InProcessChannel::Metadata> metadata_of(const Head& head, const std::string& peer,
                                               Unprintable unprintable) {
  InProcessChannel::Metadata metadata{{"hydroprint-peer", peer}};
  const auto add = [&](const char* name, std::optional<std::string_view> value) -> Status {
    if (!value) return {};
    if (unprintable == Unprintable::kRefuse && !is_printable(*value)) {
      auto error = fail(Code::kInvalidArgument, std::string(name) + ": must be printable ASCII",
                        "SPEC_INVALID");
      error.value().metadata["field"] = name;
      return error;
    }
    std::string text(*value);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return !is_printable(c); }, '?');
    metadata.emplace_back(name, std::move(text));
    return {};
  };
  HP_RETURN_IF_ERROR(add("authorization", head.fields.find("Authorization")));
  HP_RETURN_IF_ERROR(add("hydroprint-owner", head.fields.find("Hydroprint-Owner")));
  HP_RETURN_IF_ERROR(add("hydroprint-session", cookie(head.fields, kSessionCookie)));
  return metadata;
}

}  // namespace hydroprint::http
