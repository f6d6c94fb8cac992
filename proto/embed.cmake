# Writes the file INPUT as an array to the C++ file OUTPUT; proto/described.h declares its accessor.
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
file(WRITE ${OUTPUT} "#include <string_view>
namespace hydroprint {
constexpr char kBytes[] = {${bytes}};
std::string_view described_protos() { return {kBytes, sizeof(kBytes)}; }
}
")
