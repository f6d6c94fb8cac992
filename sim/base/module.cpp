#include "sim/base/module.h"

#include <dlfcn.h>

namespace hydroprint {

Result<void*> module_symbol(const std::string& file, const std::string& name) {
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* symbol = module == nullptr ? nullptr : ::dlsym(module, name.c_str());
  if (symbol != nullptr) return symbol;
  return fail(Code::kInternal, file +
                                   ": cannot be loaded. Put it beside the program and install the "
                                   "packages in deploy/packages.txt");
}

}  // namespace hydroprint
