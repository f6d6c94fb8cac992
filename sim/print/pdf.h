#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/print/page.h"

namespace hydroprint::print {

/// A PDF's bytes: pages of the paper's size, images without loss at exact scale, which viewers are
/// asked not to change when they print. Equal documents give equal bytes: there is no date in it.
/// Text is text in an embedded font (embed_font), which can be copied and searched for.
/// The samples are the printer's own amounts, untouched (DeviceRGB or DeviceCMYK); the profile goes
/// along as output intent. Fails as image::compress_rows and embed_font do.
[[nodiscard]] Result<std::vector<unsigned char>> encode_pdf(const Document& document,
                                                            const Context& context = {});

}  // namespace hydroprint::print
