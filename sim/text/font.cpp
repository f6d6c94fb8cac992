// The only file that uses FreeType.
#include "sim/text/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>
#include <utility>

#include "sim/base/input_file.h"
#include "sim/base/utf8.h"

namespace hydroprint::text {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kMostBytes = std::size_t{64} << 20;
constexpr char32_t kEllipsis = 0x2026;

tl::unexpected<Error> font_failure(const std::filesystem::path& file, const std::string& what) {
  return fail(Code::kInternal, "font " + file.string() + ": " + what +
                                   ". Install the Debian package fonts-dejavu-core");
}

}  // namespace

struct Font::Impl {
  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }

  [[nodiscard]] std::uint32_t glyph_of(char32_t character) {
    const std::scoped_lock lock(mutex);
    return FT_Get_Char_Index(face, character);
  }
  [[nodiscard]] double em() const { return face->units_per_EM; }

  /// Returns a glyph's outline in font units; nullptr if it cannot be loaded. The mutex must be
  /// locked.
  [[nodiscard]] FT_Outline* outline(std::uint32_t glyph) {
    if (FT_Load_Glyph(face, glyph, FT_LOAD_NO_SCALE | FT_LOAD_NO_HINTING) != 0) return nullptr;
    return face->glyph->format == FT_GLYPH_FORMAT_OUTLINE ? &face->glyph->outline : nullptr;
  }

  /// Bounding box of an outline, and the glyph's advance, in the font's units.
  struct Extent {
    Vector2d low = Vector2d::Zero(), high = Vector2d::Zero();
    double advance = 0;
    bool has_ink = false;
  };
  [[nodiscard]] Extent extent(std::uint32_t glyph) {
    const std::scoped_lock lock(mutex);
    Extent out;
    FT_Outline* const points = outline(glyph);
    if (points == nullptr) return out;
    out.advance = static_cast<double>(face->glyph->metrics.horiAdvance);
    if (points->n_points == 0) return out;
    FT_BBox box;
    FT_Outline_Get_CBox(points, &box);
    out.low = Vector2d(static_cast<double>(box.xMin), static_cast<double>(box.yMin));
    out.high = Vector2d(static_cast<double>(box.xMax), static_cast<double>(box.yMax));
    out.has_ink = true;
    return out;
  }

  std::string bytes;
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  double x_height = 0;  ///< height of a lower-case x, in the font's units
  std::mutex mutex;     ///< guards `face`, which has room for one glyph only
};

Font::Font(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Font::Font(Font&&) noexcept = default;
Font& Font::operator=(Font&&) noexcept = default;
Font::~Font() = default;

Result<const Font*> Font::standard() {
  static const Result<Font> font = open(HYDROPRINT_FONT);
  if (!font) return tl::unexpected(font.error());
  return &*font;
}

Result<Font> Font::open(const std::filesystem::path& file) {
  auto bytes = read_text_file(file, kMostBytes);
  if (!bytes) return font_failure(file, "missing or not readable");
  auto impl = std::make_unique<Impl>();
  impl->bytes = std::move(*bytes);
  if (FT_Init_FreeType(&impl->library) != 0) {
    return fail(Code::kInternal, "FreeType cannot start: out of memory. Free some memory",
                ErrorReason::MEMORY_LIMIT);
  }
  if (FT_New_Memory_Face(impl->library, reinterpret_cast<const FT_Byte*>(impl->bytes.data()),
                         static_cast<FT_Long>(impl->bytes.size()), 0, &impl->face) != 0) {
    impl->face = nullptr;
    return font_failure(file, "not a font that FreeType can read");
  }
  const bool is_usable = FT_IS_SCALABLE(impl->face) && impl->face->units_per_EM > 0 &&
                         impl->glyph_of('x') != 0 && impl->glyph_of(kReplacement) != 0;
  if (is_usable) impl->x_height = impl->extent(impl->glyph_of('x')).high.y();
  if (!(impl->x_height > 0)) {
    return font_failure(file, "lacks an outline of the letter x or of U+FFFD");
  }
  return Font(std::move(impl));
}

Line Font::lay_out(std::string_view text) const {
  Line out;
  std::set<char32_t> missing;
  double pen = 0;
  for (char32_t character : decode_utf8(text)) {
    std::uint32_t glyph = impl_->glyph_of(character);
    if (glyph == 0 || character == kReplacement) {
      if (missing.insert(character).second) out.missing.push_back(character);
      character = kReplacement;
      glyph = impl_->glyph_of(character);
    }
    out.glyphs.push_back({character, glyph, pen / impl_->x_height});
    const Impl::Extent extent = impl_->extent(glyph);
    if (extent.has_ink) {
      const Vector2d at(pen, 0);
      out.low = out.low.cwiseMin(at + extent.low);
      out.high = out.high.cwiseMax(at + extent.high);
    }
    pen += extent.advance;
  }
  out.high.x() = std::max(out.high.x(), pen);
  out.width = pen / impl_->x_height;
  out.low /= impl_->x_height;
  out.high /= impl_->x_height;
  return out;
}

std::string Font::shortened(std::string_view text, double width) const {
  const Line line = lay_out(text);
  if (line.width <= width) return std::string(text);
  const double room = width - lay_out(encode_utf8({&kEllipsis, 1})).width;
  if (room < 0) return {};
  const std::u32string characters = decode_utf8(text);
  std::u32string kept;
  for (std::size_t i = 0; i + 1 < line.glyphs.size(); ++i) {
    if (line.glyphs[i + 1].left > room) break;
    kept += characters[i];
  }
  while (!kept.empty() && kept.back() == ' ') kept.pop_back();
  return encode_utf8(kept + kEllipsis);
}

Coverage Font::rasterize(std::uint32_t glyph, const Vector2d& origin_px, double x_height_px) const {
  constexpr double kSubpixels = 64;      // FreeType's 26.6 fixed-point numbers
  constexpr double kMostPixels = 16384;  // a side of FreeType's raster is below 32768
  const std::scoped_lock lock(impl_->mutex);
  FT_Outline* const points = impl_->outline(glyph);
  if (points == nullptr || points->n_points == 0) return {};
  const double scale = x_height_px / impl_->x_height * kSubpixels;
  FT_BBox box;
  FT_Outline_Get_CBox(points, &box);
  const double longest =
      static_cast<double>(std::max(box.xMax - box.xMin, box.yMax - box.yMin)) * scale / kSubpixels;
  if (!origin_px.allFinite() || origin_px.cwiseAbs().maxCoeff() > kMostPixels ||
      !(longest < kMostPixels)) {
    return {};
  }
  const auto factor = static_cast<FT_Fixed>(std::lround(scale * 0x10000));
  const FT_Matrix enlarge{factor, 0, 0, factor};
  FT_Outline_Transform(points, &enlarge);
  FT_Outline_Translate(points, std::lround(origin_px.x() * kSubpixels),
                       std::lround(-origin_px.y() * kSubpixels));
  FT_Outline_Get_CBox(points, &box);
  const auto down = [](FT_Pos at) { return static_cast<int>(at >> 6); };
  const auto up = [](FT_Pos at) { return static_cast<int>((at + 63) >> 6); };
  Coverage out;
  out.left = down(box.xMin);
  out.top = -up(box.yMax);
  out.width = up(box.xMax) - out.left;
  out.height = up(box.yMax) - down(box.yMin);
  if (out.width <= 0 || out.height <= 0) return {};
  out.samples.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
  FT_Outline_Translate(points, -static_cast<FT_Pos>(out.left) * 64, -(box.yMin >> 6) * 64);
  FT_Bitmap bitmap{};
  bitmap.rows = static_cast<unsigned>(out.height);
  bitmap.width = static_cast<unsigned>(out.width);
  bitmap.pitch = out.width;
  bitmap.buffer = out.samples.data();
  bitmap.num_grays = 256;
  bitmap.pixel_mode = FT_PIXEL_MODE_GRAY;
  if (FT_Outline_Get_Bitmap(impl_->library, points, &bitmap) != 0) return {};
  return out;
}

double Font::advance_em(std::uint32_t glyph) const {
  return impl_->extent(glyph).advance / impl_->em();
}

double Font::x_height_em() const { return impl_->x_height / impl_->em(); }

FontMetrics Font::metrics() const {
  const FT_Face face = impl_->face;
  const double thousandth = 1000 / impl_->em();
  FontMetrics out;
  const char* const name = FT_Get_Postscript_Name(face);
  out.name = name == nullptr ? "Font" : name;
  out.ascent = face->ascender * thousandth;
  out.descent = face->descender * thousandth;
  out.capital_height = impl_->extent(impl_->glyph_of('H')).high.y() * thousandth;
  out.low = Vector2d(static_cast<double>(face->bbox.xMin), static_cast<double>(face->bbox.yMin)) *
            thousandth;
  out.high = Vector2d(static_cast<double>(face->bbox.xMax), static_cast<double>(face->bbox.yMax)) *
             thousandth;
  return out;
}

const std::string& Font::file() const { return impl_->bytes; }

}  // namespace hydroprint::text
