#include "sim/ink/printer_colours.h"

#include <fmt/format.h>
#include <lcms2.h>
#include <lcms2_plugin.h>

#include <algorithm>
#include <cstdlib>

#include "sim/base/input_file.h"

namespace hydroprint::ink {
namespace {

/// Limit on the size of files and of the tables that they announce. Real profiles have about 1 MiB,
/// but the library would allocate half a GiB if a damaged header announced that much.
constexpr std::size_t kMost_bytes = std::size_t{64} << 20;
constexpr std::size_t kHeader_bytes = 128;

void* allocate(cmsContext, cmsUInt32Number bytes) {
  return bytes <= kMost_bytes ? std::malloc(bytes) : nullptr;
}
void* reallocate(cmsContext, void* memory, cmsUInt32Number bytes) {
  return bytes <= kMost_bytes ? std::realloc(memory, bytes) : nullptr;
}
void release(cmsContext, void* memory) { std::free(memory); }

/// Stores the library's first message.
void note_error(cmsContext context, cmsUInt32Number, const char* text) {
  auto* message = static_cast<std::string*>(cmsGetContextUserData(context));
  if (message != nullptr && message->empty()) *message = text;
}

/// Checks the length, because the library ignores missing data at the end of the file.
Status check_whole(const std::string& bytes, const std::string& name) {
  std::size_t announced = 0;
  if (bytes.size() >= kHeader_bytes) {
    for (int i = 0; i < 4; ++i) announced = announced << 8 | static_cast<unsigned char>(bytes[i]);
  }
  if (bytes.size() < kHeader_bytes || bytes.size() < announced) {
    return fail(
        Code::kDataLoss,
        fmt::format("{}: truncated, or not an ICC profile; the file has {} bytes instead of at "
                    "least {}. Download or export the file again",
                    name, bytes.size(), std::max(announced, kHeader_bytes)));
  }
  return {};
}

}  // namespace

/// A private context of the library, so that there is no global state, and the objects created in
/// it.
class PrinterColours::LittleCms {
 public:
  LittleCms() {
    cmsPluginMemHandler memory{};
    memory.base = {cmsPluginMagicNumber, LCMS_VERSION, cmsPluginMemHandlerSig, nullptr};
    memory.MallocPtr = allocate;
    memory.ReallocPtr = reallocate;
    memory.FreePtr = release;
    context_ = cmsCreateContext(&memory, &message_);
    cmsSetLogErrorHandlerTHR(context_, note_error);
  }
  ~LittleCms() {
    if (transform_ != nullptr) cmsDeleteTransform(transform_);
    if (profile_ != nullptr) cmsCloseProfile(profile_);
    cmsDeleteContext(context_);
  }
  LittleCms(const LittleCms&) = delete;
  LittleCms& operator=(const LittleCms&) = delete;

  [[nodiscard]] Status open(const std::string& bytes, const std::string& name) {
    profile_ = cmsOpenProfileFromMemTHR(context_, bytes.data(),
                                        static_cast<cmsUInt32Number>(bytes.size()));
    if (profile_ == nullptr) return damaged(name);
    const cmsColorSpaceSignature space = cmsGetColorSpace(profile_);
    if (cmsGetDeviceClass(profile_) != cmsSigOutputClass ||
        (space != cmsSigCmykData && space != cmsSigRgbData)) {
      return fail(Code::kInvalidArgument, name +
                                              ": not the profile of a CMYK or RGB printer. "
                                              "Use an ICC output profile whose colour space "
                                              "is CMYK or RGB");
    }
    channels_ = space == cmsSigCmykData ? 4 : 3;
    const cmsHPROFILE srgb = cmsCreate_sRGBProfileTHR(context_);
    if (srgb == nullptr) return damaged(name);
    transform_ = cmsCreateTransformTHR(context_, srgb, TYPE_RGB_8, profile_,
                                       channels_ == 4 ? TYPE_CMYK_16 : TYPE_RGB_16,
                                       INTENT_RELATIVE_COLORIMETRIC, 0);
    cmsCloseProfile(srgb);
    if (transform_ == nullptr) return damaged(name);
    return {};
  }

  void convert(const std::uint8_t* rgb, std::size_t count, std::uint16_t* out) const {
    cmsDoTransform(transform_, rgb, out, static_cast<cmsUInt32Number>(count));
  }
  [[nodiscard]] int channels() const { return channels_; }

 private:
  [[nodiscard]] tl::unexpected<Error> damaged(const std::string& name) const {
    const std::string why = message_.substr(0, message_.find('\n'));
    return fail(Code::kDataLoss, name + ": damaged ICC profile" +
                                     (why.empty() ? "" : " (" + why + ")") +
                                     ". Download or export the file again");
  }

  std::string message_;
  cmsContext context_ = nullptr;
  cmsHPROFILE profile_ = nullptr;
  cmsHTRANSFORM transform_ = nullptr;
  int channels_ = 4;
};

Result<PrinterColours> PrinterColours::open(const std::filesystem::path& icc_profile) {
  const std::string name = icc_profile.string();
  PrinterColours out;
  HP_ASSIGN_OR_RETURN(out.icc_profile_, read_text_file(icc_profile, kMost_bytes));
  HP_RETURN_IF_ERROR(check_whole(out.icc_profile_, name));
  const auto cms = std::make_shared<LittleCms>();
  HP_RETURN_IF_ERROR(cms->open(out.icc_profile_, name));
  out.cms_ = cms;
  return out;
}

int PrinterColours::channels() const { return cms_->channels(); }

void PrinterColours::convert(const std::uint8_t* rgb, std::size_t count, std::uint16_t* out) const {
  cms_->convert(rgb, count, out);
}

}  // namespace hydroprint::ink
