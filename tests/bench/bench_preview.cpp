// Measures a preview of the 60 mm sphere on A4 with the mesh in memory. See README.md.
#include <algorithm>
#include <chrono>
#include <vector>

#include "sim/pipeline/dip.h"
#include "sim/pipeline/preview.h"
#include "sim/sample/icosphere.h"
#include "tests/bench/figures.h"

namespace hydroprint::bench {
namespace {

constexpr int kRuns = 21;

double seconds_now() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

void measure() {
  const mesh::Model model = sample::icosphere(60, 6);
  const pipeline::DipOptions options = pipeline::preview_of(testing::sphere_options("A4", 60, 120));
  std::vector<double> seconds;
  for (int run = 0; run < kRuns; ++run) {
    const double start = seconds_now();
    value_of(pipeline::dip(model, options, two_threads()));
    seconds.push_back(seconds_now() - start);
  }
  std::sort(seconds.begin(), seconds.end());
  print("preview", {{"seconds", seconds[kRuns / 2]},
                    {"min..max", {seconds.front(), seconds.back()}},
                    {"triangles", model.triangles.size()}});
}

}  // namespace
}  // namespace hydroprint::bench

int main() { hydroprint::bench::measure(); }
