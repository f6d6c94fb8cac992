#pragma once

#include <functional>

#include "daemon/platform/check_line.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::admin {

/// Checks the structure of a database, and reads all files of the store to compare them with it:
/// files that are missing, have another size or another content, and files without a row. A daemon
/// may be using the store. Shows its progress on stderr.
/// @param add             called for each result
/// @param is_interrupted  ends the check early if it returns true
void check_store(const daemon::Layout& layout,
                 const std::function<void(const daemon::CheckLine&)>& add,
                 const std::function<bool()>& is_interrupted);

}  // namespace hydroprint::admin
