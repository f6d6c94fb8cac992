#include "tests/bench/figures.h"

#include <cstdio>
#include <cstdlib>

namespace hydroprint::bench {

void print(const std::string& row, Json figures) {
  Json line = {{"row", row}};
  line.update(figures);
  std::puts(line.dump().c_str());
  std::fflush(stdout);
}

Json json_of(const testing::Errors& errors) {
  return {{"rms_mm", errors.summary.rms},
          {"max_mm", errors.summary.max},
          {"points", errors.summary.count},
          {"missing", errors.missing}};
}

void give_up(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  std::exit(1);
}

}  // namespace hydroprint::bench
