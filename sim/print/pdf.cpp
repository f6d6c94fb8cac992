// The only file that uses QPDF. Of the PDF writers in Debian, only QPDF leaves every number and
// every byte of a stream to the caller. Cairo has no CMYK, libharu computes in single precision and
// accepts ICC profiles only for PDF/A, and PoDoFo 0.9 writes dates. QPDF compresses in one thread,
// so images are compressed beforehand as in a PNG, which PDF accepts unchanged.
#include "sim/print/pdf.h"

#define POINTERHOLDER_TRANSITION 4  // required by its headers; 4: its old pointers are not used

#include <array>
#include <charconv>
#include <exception>
#include <memory>
#include <qpdf/Buffer.hh>
#include <qpdf/QPDF.hh>
#include <qpdf/QPDFObjectHandle.hh>
#include <qpdf/QPDFWriter.hh>
#include <string>

#include "sim/image/io/png.h"

namespace hydroprint::print {
namespace {

constexpr double kPointsPerMm = 72 / 25.4;

/// Six digits after the decimal point: a millionth of a point.
std::string number(double value) {
  std::array<char, 64> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::fixed, 6);
  return {buffer.data(), end.ptr};
}

std::string points(double mm) { return number(mm * kPointsPerMm); }

std::string place(const Eigen::Vector2d& mm) { return points(mm.x()) + " " + points(mm.y()); }

QPDFObjectHandle name(const std::string& text) { return QPDFObjectHandle::newName("/" + text); }

QPDFObjectHandle integer(long long value) { return QPDFObjectHandle::newInteger(value); }

/// An image with its rows compressed by compress_rows().
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
  return "q " + points(size_mm.x()) + " 0 0 " + points(size_mm.y()) + " " + place(placed.low_mm) +
         " cm /Im" + std::to_string(index) + " Do Q\n";
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

QPDFObjectHandle box(const Eigen::Vector2d& size_mm) {
  QPDFObjectHandle out = QPDFObjectHandle::newArray();
  for (const double side_mm : {0.0, 0.0, size_mm.x(), size_mm.y()}) {
    out.appendItem(QPDFObjectHandle::newReal(points(side_mm)));
  }
  return out;
}

Status add_page(QPDF& pdf, const Page& page, bool cmyk, const Context& context) {
  QPDFObjectHandle images = QPDFObjectHandle::newDictionary();
  std::string content;
  for (std::size_t i = 0; i < page.images.size(); ++i) {
    HP_ASSIGN_OR_RETURN(const QPDFObjectHandle object,
                        image_object(pdf, page.images[i].image, context));
    images.replaceKey("/Im" + std::to_string(i), object);
    content += drawn(page.images[i], i);
  }
  content += "1 J 1 j\n";  // round pen
  for (const Stroke& stroke : page.strokes) content += drawn(stroke, cmyk);

  QPDFObjectHandle resources = QPDFObjectHandle::newDictionary();
  resources.replaceKey("/XObject", images);
  QPDFObjectHandle object = QPDFObjectHandle::newDictionary();
  object.replaceKey("/Type", name("Page"));
  object.replaceKey("/MediaBox", box(page.size_mm));
  object.replaceKey("/Resources", resources);
  object.replaceKey("/Contents", QPDFObjectHandle::newStream(&pdf, content));
  pdf.addPage(pdf.makeIndirectObject(object), false);
  return {};
}

/// States the meaning of the samples: amounts for the printer that the profile describes.
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
  info.replaceKey("/Title", QPDFObjectHandle::newUnicodeString(document.title));
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
    for (const Page& page : document.pages) {
      HP_RETURN_IF_ERROR(check_cancelled(context));
      HP_RETURN_IF_ERROR(add_page(pdf, page, document.cmyk, context));
    }
    describe(pdf, document);
    return written(pdf);
  } catch (const std::bad_alloc&) {
    return fail(Code::kInternal, "PDF: out of memory. Lower the dpi", "OUT_OF_MEMORY");
  } catch (const std::exception& error) {
    return fail(Code::kInternal,
                std::string("PDF: cannot be written (") + error.what() + "). Please report this");
  }
}

}  // namespace hydroprint::print
