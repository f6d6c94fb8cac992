#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Severity of a log line; the names are the values of the configuration key log.level. kCritical
/// is never left out: a person must act at once.
enum class LogLevel { kDebug, kInfo, kWarning, kError, kCritical };

/// One key=value pair of a log line. Values with blanks, quotes or control characters are quoted
/// and escaped, so untrusted text cannot add lines.
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

/// Starts logging to stderr and, unless `file` is empty, to the end of that file.
/// @return kPermissionDenied if the file cannot be opened
[[nodiscard]] Status start_logging(LogLevel level, const std::filesystem::path& file);

/// Writes a line such as "time level=info event=job_started job=7 owner=ann". Thread-safe.
void log(LogLevel level, std::string_view event, std::initializer_list<LogField> fields = {});

}  // namespace hydroprint::daemon
