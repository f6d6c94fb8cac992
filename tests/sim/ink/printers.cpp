#include "tests/sim/ink/printers.h"

#include <lcms2.h>

#include <cmath>
#include <stdexcept>

namespace hydroprint::ink::testing {
namespace {

void expect(bool done) {
  if (!done) throw std::runtime_error("Little CMS could not create a profile");
}

std::string saved(cmsHPROFILE profile) {
  cmsUInt32Number size = 0;
  expect(cmsSaveProfileToMem(profile, nullptr, &size));
  std::string bytes(size, '\0');
  expect(cmsSaveProfileToMem(profile, bytes.data(), &size));
  cmsCloseProfile(profile);
  return bytes;
}

cmsInt32Number ink_of_lab(const cmsUInt16Number lab[], cmsUInt16Number cmyk[], void* share) {
  for (int i = 0; i < 4; ++i) {
    cmyk[i] = static_cast<cmsUInt16Number>(
        std::lround(*static_cast<const double*>(share) * (65535 - lab[0])));
  }
  return 1;
}

/// Writes a table of ink amounts by Lab colour. The amounts are linear in L*, so two grid points
/// are enough.
void write_table(cmsHPROFILE profile, cmsTagSignature tag, double share) {
  cmsPipeline* table = cmsPipelineAlloc(nullptr, 3, 4);
  cmsStage* clut = cmsStageAllocCLut16bit(nullptr, 2, 3, 4, nullptr);
  expect(cmsStageSampleCLut16bit(clut, ink_of_lab, &share, 0));
  expect(cmsPipelineInsertStage(table, cmsAT_END, cmsStageAllocToneCurves(nullptr, 3, nullptr)));
  expect(cmsPipelineInsertStage(table, cmsAT_END, clut));
  expect(cmsPipelineInsertStage(table, cmsAT_END, cmsStageAllocToneCurves(nullptr, 4, nullptr)));
  expect(cmsWriteTag(profile, tag, table));
  cmsPipelineFree(table);
}

}  // namespace

std::string icc_profile(const Printer& printer) {
  const cmsHPROFILE profile = cmsCreateProfilePlaceholder(nullptr);
  cmsSetProfileVersion(profile, 4.3);
  cmsSetDeviceClass(profile, cmsSigOutputClass);
  cmsSetColorSpace(profile, cmsSigCmykData);
  cmsSetPCS(profile, cmsSigLabData);
  expect(cmsWriteTag(profile, cmsSigMediaWhitePointTag, cmsD50_XYZ()));
  write_table(profile, cmsSigBToA0Tag, printer.perceptual);
  write_table(profile, cmsSigBToA1Tag, printer.colorimetric);
  return saved(profile);
}

std::string srgb_profile() { return saved(cmsCreate_sRGBProfile()); }

std::string cmyk_link_profile() {
  return saved(cmsCreateInkLimitingDeviceLink(cmsSigCmykData, 300));
}

std::string rgb_printer_profile() {
  const cmsHPROFILE profile = cmsCreate_sRGBProfile();
  cmsSetDeviceClass(profile, cmsSigOutputClass);
  return saved(profile);
}

}  // namespace hydroprint::ink::testing
