#include "sim/base/one_line.h"

#include <algorithm>

#include "sim/base/utf8.h"

namespace hydroprint {

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return encode_utf8(decode_utf8(text));
}

}  // namespace hydroprint
