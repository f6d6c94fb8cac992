// hydroprint-openapi: prints the OpenAPI document of the daemon's HTTP interface.
#include <iostream>

#include "daemon/rest/openapi/openapi.h"

int main() {
  const auto document = hydroprint::rest::openapi();
  if (!document) {
    std::cerr << "hydroprint-openapi: " << document.error().message << '\n';
    return 4;
  }
  std::cout << *document << std::flush;
  return std::cout ? 0 : 4;
}
