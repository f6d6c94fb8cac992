#include "sim/base/process/error_output.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "sim/base/utf8.h"

namespace hydroprint::worker {

void print_error(const Error& error, ExitStatus status, bool json, std::string_view program) {
  const std::string message = one_line(error.message);
  std::fprintf(stderr, "%.*s: %s\n", static_cast<int>(program.size()), program.data(),
               message.c_str());
  if (!json) return;
  const nlohmann::ordered_json object = {{"error",
                                          {{"code", code_name(error.code)},
                                           {"reason", error.reason},
                                           {"message", message},
                                           {"metadata", error.metadata},
                                           {"exit_status", static_cast<int>(status)}}}};
  const std::string text =
      object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace hydroprint::worker
