#pragma once

#include <sstream>
#include <string>

namespace hydroprint::dip {

/// Concatenates the parts as text, with numbers in their default format.
template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

}  // namespace hydroprint::dip
