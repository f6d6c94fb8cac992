#include "client/cli/format/durations.h"

#include <map>
#include <string>

namespace hydroprint::cli {

void add_duration(CLI::App& command, const char* flag, std::optional<double>& time_s,
                  const char* help) {
  const std::map<std::string, double> units{{"ms", 0.001}, {"s", 1}, {"min", 60}, {"h", 3600}};
  command.add_option(flag, time_s, help)
      ->transform(CLI::AsNumberWithUnit(units, CLI::AsNumberWithUnit::CASE_SENSITIVE))
      ->check(CLI::Range(0.001, 1e6))
      ->type_name("TIME");
}

}  // namespace hydroprint::cli
