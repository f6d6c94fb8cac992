// The importer's code is compiled here with hidden visibility instead of being linked. libdraco,
// which other libraries bring along, exports another version of the same symbols. With linking, the
// order of a program's libraries would decide which version is called.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
