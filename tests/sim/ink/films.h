#pragma once

#include <string>

#include "sim/film/outline.h"

namespace hydroprint::ink {

inline film::Outline outline_of(const std::string& text) { return *film::parse_outline(text); }

}  // namespace hydroprint::ink
