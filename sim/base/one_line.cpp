#include "sim/base/one_line.h"

#include <algorithm>

namespace hydroprint {

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return text;
}

}  // namespace hydroprint
