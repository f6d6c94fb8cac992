// The only file that uses QPDF. Of the PDF writers in Debian, only QPDF lets the caller control
// every number and every byte of a stream. Cairo does not support CMYK, libharu computes in single
// precision and accepts ICC profiles only for PDF/A, and PoDoFo 0.9 writes dates. QPDF compresses
// in one thread, so images are compressed in advance as in a PNG, which PDF accepts unchanged.
#include "sim/print/pdf.h"

// Required by the headers of QPDF; 4: its deprecated pointer type is not used.
#define POINTERHOLDER_TRANSITION 4

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <qpdf/Buffer.hh>
#include <qpdf/QPDF.hh>
#include <qpdf/QPDFObjectHandle.hh>
#include <qpdf/QPDFWriter.hh>
#include <string>

#include "sim/base/utf8.h"
#include "sim/image/io/png.h"
#include "sim/print/embedded_font.h"

namespace hydroprint::print {
namespace {

constexpr double kPointsPerMm = 72 / 25.4;

/// Formats a number with six decimal places: a millionth of a point.
std::string number(double value) { return fmt::format("{:.6f}", value); }

std::string points(double mm) { return number(mm * kPointsPerMm); }

std::string place(const Eigen::Vector2d& mm) { return points(mm.x()) + " " + points(mm.y()); }

QPDFObjectHandle name(const std::string& text) { return QPDFObjectHandle::newName("/" + text); }

QPDFObjectHandle integer(long long value) { return QPDFObjectHandle::newInteger(value); }

/// Returns an image with its rows compressed by compress_rows().
Result<QPDFObjectHandle> image_object(QPDF& pdf, const image::PrinterImage& image,
                                      const Context& context) {
  HP_ASSIGN_OR_RETURN(const auto rows, image::compress_rows(image.samples.data(), image.width,
                                                            image.height, image.channels, context));
  QPDFObjectHandle parameters = QPDFObjectHandle::newDictionary();
  parameters.replaceKey("/Predictor", integer(15));  // every row states its filter
  parameters.replaceKey("/Colors", integer(image.channels));
  parameters.replaceKey("/BitsPerComponent", integer(8));
  parameters.replaceKey("/Columns", integer(image.width));

  QPDFObjectHandle object = QPDFObjectHandle::newStream(&pdf);
  QPDFObjectHandle dictionary = object.getDict();
  dictionary.replaceKey("/Type", name("XObject"));
  dictionary.replaceKey("/Subtype", name("Image"));
  dictionary.replaceKey("/Width", integer(image.width));
  dictionary.replaceKey("/Height", integer(image.height));
  dictionary.replaceKey("/ColorSpace", name(image.channels == 4 ? "DeviceCMYK" : "DeviceRGB"));
  dictionary.replaceKey("/BitsPerComponent", integer(8));
  dictionary.replaceKey("/Interpolate", QPDFObjectHandle::newBool(false));
  object.replaceStreamData(std::string(rows.begin(), rows.end()), name("FlateDecode"), parameters);
  return object;
}

std::string drawn(const PlacedImage& placed, std::size_t index) {
  const Eigen::Vector2d size_mm =
      Eigen::Vector2d(placed.image.width, placed.image.height) * placed.pitch_mm;
  return fmt::format("q {} 0 0 {} {} cm /Im{} Do Q\n", points(size_mm.x()), points(size_mm.y()),
                     place(placed.low_mm), index);
}

std::string drawn(const Stroke& stroke, bool cmyk) {
  if (stroke.points_mm.empty()) return {};
  std::string out = points(stroke.width_mm) + " w ";
  out += cmyk ? "0 0 0 " + number(stroke.ink) + " K " : number(1 - stroke.ink) + " G ";
  const char* how = " m ";
  for (const Eigen::Vector2d& point : stroke.points_mm) {
    out += place(point) + how;
    how = " l ";
  }
  return out + "S\n";
}

std::string drawn(const Text& text, const EmbeddedFont& font, bool cmyk) {
  return "BT " + (cmyk ? "0 0 0 " + number(text.ink) + " k " : number(1 - text.ink) + " g ") +
         "/F0 " + points(text.x_height_mm / font.font->x_height_em()) + " Tf " + place(text.at_mm) +
         " Td " + font.encoded(text.text) + " Tj ET\n";
}

QPDFObjectHandle box(const Eigen::Vector2d& size_mm) {
  QPDFObjectHandle out = QPDFObjectHandle::newArray();
  for (const double side_mm : {0.0, 0.0, size_mm.x(), size_mm.y()}) {
    out.appendItem(QPDFObjectHandle::newReal(points(side_mm)));
  }
  return out;
}

QPDFObjectHandle real(double value) { return QPDFObjectHandle::newReal(number(value)); }

QPDFObjectHandle font_descriptor(QPDF& pdf, const EmbeddedFont& font) {
  constexpr int kSymbolic = 4;  // the characters of the font are not a standard set
  constexpr int kStem = 80;     // an estimate, used only by viewers that substitute the font
  const text::FontMetrics& metrics = font.metrics;
  QPDFObjectHandle file = QPDFObjectHandle::newStream(&pdf, font.file);
  file.getDict().replaceKey("/Length1", integer(static_cast<long long>(font.file.size())));
  QPDFObjectHandle bounds = QPDFObjectHandle::newArray();
  for (const Eigen::Vector2d& corner : {metrics.low, metrics.high}) {
    bounds.appendItem(real(corner.x()));
    bounds.appendItem(real(corner.y()));
  }
  QPDFObjectHandle out = QPDFObjectHandle::newDictionary();
  out.replaceKey("/Type", name("FontDescriptor"));
  out.replaceKey("/FontName", name(metrics.name));
  out.replaceKey("/Flags", integer(kSymbolic));
  out.replaceKey("/FontBBox", bounds);
  out.replaceKey("/ItalicAngle", integer(0));
  out.replaceKey("/Ascent", real(metrics.ascent));
  out.replaceKey("/Descent", real(metrics.descent));
  out.replaceKey("/CapHeight", real(metrics.capital_height));
  out.replaceKey("/StemV", integer(kStem));
  out.replaceKey("/FontFile2", file);
  return pdf.makeIndirectObject(out);
}

QPDFObjectHandle descendant_font(QPDF& pdf, const EmbeddedFont& font) {
  QPDFObjectHandle system = QPDFObjectHandle::newDictionary();
  system.replaceKey("/Registry", QPDFObjectHandle::newString("Adobe"));
  system.replaceKey("/Ordering", QPDFObjectHandle::newString("Identity"));
  system.replaceKey("/Supplement", integer(0));
  QPDFObjectHandle each = QPDFObjectHandle::newArray();
  for (const double width : font.widths) each.appendItem(real(width));
  QPDFObjectHandle widths = QPDFObjectHandle::newArray();
  widths.appendItem(integer(0));
  widths.appendItem(each);
  QPDFObjectHandle out = QPDFObjectHandle::newDictionary();
  out.replaceKey("/Type", name("Font"));
  out.replaceKey("/Subtype", name("CIDFontType2"));
  out.replaceKey("/BaseFont", name(font.metrics.name));
  out.replaceKey("/CIDSystemInfo", system);
  out.replaceKey("/FontDescriptor", font_descriptor(pdf, font));
  out.replaceKey("/W", widths);
  out.replaceKey("/CIDToGIDMap", QPDFObjectHandle::newStream(&pdf, font.cid_to_gid));
  return pdf.makeIndirectObject(out);
}

QPDFObjectHandle font_object(QPDF& pdf, const EmbeddedFont& font) {
  QPDFObjectHandle descendants = QPDFObjectHandle::newArray();
  descendants.appendItem(descendant_font(pdf, font));
  QPDFObjectHandle out = QPDFObjectHandle::newDictionary();
  out.replaceKey("/Type", name("Font"));
  out.replaceKey("/Subtype", name("Type0"));
  out.replaceKey("/BaseFont", name(font.metrics.name));
  out.replaceKey("/Encoding", name("Identity-H"));
  out.replaceKey("/DescendantFonts", descendants);
  out.replaceKey("/ToUnicode", QPDFObjectHandle::newStream(&pdf, font.to_unicode));
  return pdf.makeIndirectObject(out);
}

/// The font of a document's texts, and the object that its pages refer to.
struct DocumentFont {
  EmbeddedFont font;
  QPDFObjectHandle object;
};

Result<std::optional<DocumentFont>> document_font(QPDF& pdf, const Document& document) {
  const auto has_text = [](const Page& page) { return !page.texts.empty(); };
  if (std::none_of(document.pages.begin(), document.pages.end(), has_text)) return std::nullopt;
  DocumentFont out;
  HP_ASSIGN_OR_RETURN(out.font, embed_font(document.pages));
  out.object = font_object(pdf, out.font);
  return out;
}

Status add_page(QPDF& pdf, const Page& page, bool cmyk, const std::optional<DocumentFont>& font,
                const Context& context) {
  QPDFObjectHandle images = QPDFObjectHandle::newDictionary();
  std::string content;
  for (std::size_t i = 0; i < page.images.size(); ++i) {
    HP_ASSIGN_OR_RETURN(const QPDFObjectHandle object,
                        image_object(pdf, page.images[i].image, context));
    images.replaceKey(fmt::format("/Im{}", i), object);
    content += drawn(page.images[i], i);
  }
  content += "1 J 1 j\n";  // round pen
  for (const Stroke& stroke : page.strokes) content += drawn(stroke, cmyk);
  for (const Text& text : page.texts) content += drawn(text, font->font, cmyk);

  QPDFObjectHandle resources = QPDFObjectHandle::newDictionary();
  resources.replaceKey("/XObject", images);
  if (!page.texts.empty()) {
    QPDFObjectHandle fonts = QPDFObjectHandle::newDictionary();
    fonts.replaceKey("/F0", font->object);
    resources.replaceKey("/Font", fonts);
  }
  QPDFObjectHandle object = QPDFObjectHandle::newDictionary();
  object.replaceKey("/Type", name("Page"));
  object.replaceKey("/MediaBox", box(page.size_mm));
  object.replaceKey("/Resources", resources);
  object.replaceKey("/Contents", QPDFObjectHandle::newStream(&pdf, content));
  pdf.addPage(pdf.makeIndirectObject(object), false);
  return {};
}

/// Declares the meaning of the samples: ink amounts for the printer described by the profile.
QPDFObjectHandle output_intents(QPDF& pdf, const Document& document) {
  QPDFObjectHandle profile = QPDFObjectHandle::newStream(&pdf, document.icc_profile);
  profile.getDict().replaceKey("/N", integer(document.cmyk ? 4 : 3));
  QPDFObjectHandle intent = QPDFObjectHandle::newDictionary();
  intent.replaceKey("/Type", name("OutputIntent"));
  intent.replaceKey("/S", name("GTS_PDFX"));
  intent.replaceKey("/OutputConditionIdentifier", QPDFObjectHandle::newString("Custom"));
  intent.replaceKey("/Info", QPDFObjectHandle::newString("the printer's ICC profile"));
  intent.replaceKey("/DestOutputProfile", profile);
  QPDFObjectHandle intents = QPDFObjectHandle::newArray();
  intents.appendItem(intent);
  return intents;
}

void describe(QPDF& pdf, const Document& document) {
  QPDFObjectHandle viewer = QPDFObjectHandle::newDictionary();
  viewer.replaceKey("/PrintScaling", name("None"));
  pdf.getRoot().replaceKey("/ViewerPreferences", viewer);
  if (!document.icc_profile.empty()) {
    pdf.getRoot().replaceKey("/OutputIntents", output_intents(pdf, document));
  }
  QPDFObjectHandle info = QPDFObjectHandle::newDictionary();
  // The job name may be malformed UTF-8, which a PDF must not contain.
  const std::string title = encode_utf8(decode_utf8(document.title));
  info.replaceKey("/Title", QPDFObjectHandle::newUnicodeString(title));
  info.replaceKey("/Producer", QPDFObjectHandle::newString("Hydroprint"));
  pdf.getTrailer().replaceKey("/Info", pdf.makeIndirectObject(info));
}

std::vector<unsigned char> written(QPDF& pdf) {
  QPDFWriter writer(pdf);
  writer.setOutputMemory();
  writer.setDeterministicID(true);
  writer.setMinimumPDFVersion("1.6");
  writer.write();
  const std::unique_ptr<Buffer> buffer(writer.getBuffer());
  return {buffer->getBuffer(), buffer->getBuffer() + buffer->getSize()};
}

}  // namespace

Result<std::vector<unsigned char>> encode_pdf(const Document& document, const Context& context) {
  try {
    QPDF pdf;
    pdf.emptyPDF();
    HP_ASSIGN_OR_RETURN(const auto font, document_font(pdf, document));
    for (const Page& page : document.pages) {
      HP_RETURN_IF_ERROR(check_cancelled(context));
      HP_RETURN_IF_ERROR(add_page(pdf, page, document.cmyk, font, context));
    }
    describe(pdf, document);
    return written(pdf);
  } catch (const std::bad_alloc&) {
    return fail(Code::kInternal, "PDF: out of memory. Free some memory", ErrorReason::MEMORY_LIMIT);
  } catch (const std::exception& error) {
    return fail(Code::kInternal,
                std::string("PDF: cannot be written (") + error.what() + "). Please report this");
  }
}

}  // namespace hydroprint::print
