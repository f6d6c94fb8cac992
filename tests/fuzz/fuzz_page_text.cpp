// Lays out any bytes as a line of text. There must be no crash and no hang, shortened text must
// fit, and a PDF must be able to embed the glyphs.
#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "sim/base/utf8.h"
#include "sim/text/font.h"
#include "sim/text/font_subset.h"
#include "tests/fuzz/expect.h"

namespace hydroprint::fuzz {
namespace {

void try_text(std::string_view bytes) {
  static const text::Font& font = *text::Font::standard().value();
  const std::u32string decoded = decode_utf8(bytes);
  HP_EXPECT(decode_utf8(encode_utf8(decoded)) == decoded);
  const text::Line line = font.lay_out(bytes);
  HP_EXPECT(line.glyphs.size() == decoded.size());
  HP_EXPECT(line.width >= 0 && line.low.allFinite() && line.high.allFinite());
  const double width = static_cast<double>(bytes.size() % 50);
  HP_EXPECT(font.lay_out(font.shortened(bytes, width)).width <= width + 1e-9);
  std::set<std::uint32_t> glyphs = {0};
  for (const text::PlacedGlyph& glyph : line.glyphs) {
    (void)font.rasterize(glyph.glyph, {glyph.left * 9, 20}, 9);
    glyphs.insert(glyph.glyph);
  }
  const auto subset = text::make_subset(font, glyphs);
  HP_EXPECT(subset && subset->glyphs.size() == glyphs.size());
}

}  // namespace
}  // namespace hydroprint::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hydroprint::fuzz::try_text({reinterpret_cast<const char*>(data), size});
  return 0;
}
