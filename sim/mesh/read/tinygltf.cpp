// The importer's code is compiled here with hidden visibility instead of being linked. libdraco, a
// dependency of assimp, exports another version of the same symbols, and the order of a program's
// libraries decided which of the two it called.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
