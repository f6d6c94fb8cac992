#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/print/page.h"

namespace hydroprint::print {

/// Encodes a document as PDF, with pages of the paper's size and lossless images at exact scale.
/// Asks viewers not to scale the pages when printing. Equal documents yield equal bytes, because
/// the PDF contains no date. The samples are the printer's own amounts, unchanged (DeviceRGB or
/// DeviceCMYK); the profile is added as output intent. Returns the errors of
/// image::compress_rows().
[[nodiscard]] Result<std::vector<unsigned char>> encode_pdf(const Document& document,
                                                            const Context& context = {});

}  // namespace hydroprint::print
