#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/print/page.h"

namespace hydroprint::print {

/// A PDF's bytes: pages of the paper's size, with lossless images at exact scale. Viewers are asked
/// not to scale them when printing. Equal documents give equal bytes, because there is no date in
/// them. The samples are the printer's own amounts, unchanged (DeviceRGB or DeviceCMYK); the
/// profile is added as output intent. Fails as image::compress_rows() does.
[[nodiscard]] Result<std::vector<unsigned char>> encode_pdf(const Document& document,
                                                            const Context& context = {});

}  // namespace hydroprint::print
