#include "sim/image/io/colour_profile.h"

#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

namespace hydroprint::image {
namespace {

using Profile = std::shared_ptr<void>;

Profile owned(cmsHPROFILE profile) {
  return {profile, [](void* p) {
            if (p != nullptr) cmsCloseProfile(p);
          }};
}

/// Half a step of 8 bits in 16-bit values.
constexpr int kHalfStep = 257 / 2;

}  // namespace

tl::expected<ProfileToSrgb, std::string> ProfileToSrgb::create(
    std::span<const std::uint8_t> profile, int channels) {
  if (profile.size() > kMaxProfile_bytes)
    return tl::unexpected<std::string>("it is larger than 16 MiB");
  const Profile from =
      owned(cmsOpenProfileFromMem(profile.data(), static_cast<cmsUInt32Number>(profile.size())));
  if (!from) return tl::unexpected<std::string>("it is damaged");
  const cmsColorSpaceSignature space = cmsGetColorSpace(from.get());
  if (space != cmsSigRgbData && !(space == cmsSigGrayData && channels == 1))
    return tl::unexpected<std::string>("it is not one of the image's colour space");
  const Profile to = owned(cmsCreate_sRGBProfile());
  ProfileToSrgb out;
  out.inputs_ = space == cmsSigGrayData ? 1 : 3;
  // Not optimised, because the optimised transform of 16-bit values is a table of 33 steps, which
  // is wrong by up to nineteen 8-bit codes where colours leave the gamut.
  const cmsHTRANSFORM transform = cmsCreateTransform(
      from.get(), out.inputs_ == 1 ? TYPE_GRAY_16 : TYPE_RGB_16, to.get(), TYPE_RGB_16,
      INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_BLACKPOINTCOMPENSATION | cmsFLAGS_NOOPTIMIZE);
  if (transform == nullptr) return tl::unexpected<std::string>("it cannot be used");
  out.transform_ = {transform, cmsDeleteTransform};

  // Whether it changes anything: greys, and a grid of colours.
  std::vector<std::uint16_t> probe;
  for (int value = 0; value < 256; ++value)
    probe.insert(probe.end(), static_cast<std::size_t>(out.inputs_),
                 static_cast<std::uint16_t>(257 * value));
  for (int i = 0; out.inputs_ == 3 && i < 729; ++i)
    for (const int digit : {i / 81, i / 9 % 9, i % 9})
      probe.push_back(static_cast<std::uint16_t>(8191 * digit));
  const std::size_t count = probe.size() / static_cast<std::size_t>(out.inputs_);
  std::vector<std::uint16_t> converted(3 * count);
  out.convert(probe.data(), count, converted.data());
  out.is_srgb_ = true;
  for (std::size_t i = 0; i < converted.size(); ++i) {
    const int before = probe[out.inputs_ == 3 ? i : i / 3];
    if (std::abs(converted[i] - before) > kHalfStep) out.is_srgb_ = false;
  }
  return out;
}

void ProfileToSrgb::convert(const std::uint16_t* from, std::size_t count, std::uint16_t* to) const {
  cmsDoTransform(transform_.get(), from, to, static_cast<cmsUInt32Number>(count));
}

}  // namespace hydroprint::image
