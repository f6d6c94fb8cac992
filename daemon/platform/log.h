#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// How loud a line is; the names are those of the configuration key log.level.
enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// One key=value pair of a log line. Values with blanks, quotes or control characters are quoted
/// and escaped, so that one line stays one line whatever a client sent.
struct LogField {
  LogField(std::string_view name, std::string_view text);
  LogField(std::string_view name, const char* text) : LogField(name, std::string_view(text)) {}
  LogField(std::string_view name, const std::string& text)
      : LogField(name, std::string_view(text)) {}
  LogField(std::string_view name, std::int64_t number);
  LogField(std::string_view name, int number) : LogField(name, std::int64_t{number}) {}

  std::string key;
  std::string value;
};

/// Sends the log to stderr and, unless empty, to a file as well (appended).
/// @return kPermissionDenied if the file cannot be opened
[[nodiscard]] Status start_logging(LogLevel level, const std::filesystem::path& file);

/// Writes "time level=info event=job_started job=7 owner=ann". Callable from any thread.
void log(LogLevel level, std::string_view event, std::initializer_list<LogField> fields = {});

}  // namespace hydroprint::daemon
