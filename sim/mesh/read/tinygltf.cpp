// The importer's code, compiled here and kept out of sight (hidden visibility) instead of linked:
// libdraco, which assimp brings along, exports another version of the same names, and which of the
// two a program would call depended on the order of its libraries.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
