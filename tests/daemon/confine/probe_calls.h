#pragma once

#include <string>

/// Prints the outcome of an action: "ACTION: yes", or "ACTION: REASON" with the reason in errno.
void print(const std::string& action, bool succeeded);

/// Tries each call that is refused. `file` may be created. All are harmless if they succeed.
void try_refused_calls(const std::string& file);
/// Tries each call that does not exist for a confined program.
void try_missing_calls(const std::string& file);
/// Uses what the libraries of workers need. `folder` may be written to.
void use_needed_calls(const std::string& folder);
/// Makes a call of the binary interface "i386" or "x32".
void call_as(const std::string& interface);
