# Writes the content of the file INPUT as an array into the C++ file OUTPUT; proto/described.h declares it.
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
file(WRITE ${OUTPUT} "#include <string_view>
namespace hydroprint {
constexpr char kBytes[] = {${bytes}};
std::string_view described_protos() { return {kBytes, sizeof(kBytes)}; }
}
")
