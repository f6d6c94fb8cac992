#include "sim/base/process/error_output.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "sim/base/utf8.h"

namespace hydroprint::worker {

nlohmann::ordered_json failure_json(const Error& error) {
  nlohmann::ordered_json failure = {{"code", code_name(error.code)}};
  if (error.reason != ErrorReason{}) failure["reason"] = name_of(error.reason);
  failure["message"] = one_line(error.message);
  if (!error.field.empty()) failure["field"] = error.field;
  return failure;
}

void print_failure(const Error& error, ExitStatus status) {
  nlohmann::ordered_json failure = failure_json(error);
  failure["exit_status"] = static_cast<int>(status);
  const std::string text = nlohmann::ordered_json{{"error", std::move(failure)}}.dump(
                               -1, ' ', false, nlohmann::json::error_handler_t::replace) +
                           "\n";
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

void print_error(std::string_view program, std::string_view words) {
  const std::string line = one_line(std::string(words));
  std::fprintf(stderr, "%.*s: %s\n", static_cast<int>(program.size()), program.data(),
               line.c_str());
}

}  // namespace hydroprint::worker
