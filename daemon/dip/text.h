#pragma once

#include <sstream>
#include <string>

namespace hydroprint::dip {

/// The parts, numbers as they are shown, one after the other.
template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

}  // namespace hydroprint::dip
