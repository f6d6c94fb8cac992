// The only file that uses HarfBuzz.
#include "sim/text/font_subset.h"

#include <hb-subset.h>

#include <array>
#include <memory>

namespace hydroprint::text {
namespace {

template <auto Destroy>
struct Destroyer {
  template <class T>
  void operator()(T* object) const {
    Destroy(object);
  }
};
template <class T, auto Destroy>
using Owned = std::unique_ptr<T, Destroyer<Destroy>>;

using Blob = Owned<hb_blob_t, hb_blob_destroy>;
using Face = Owned<hb_face_t, hb_face_destroy>;
using Input = Owned<hb_subset_input_t, hb_subset_input_destroy>;
using Plan = Owned<hb_subset_plan_t, hb_subset_plan_destroy>;

/// A PDF refers to glyphs by number, so it needs neither the tables for selecting and placing
/// glyphs nor the table of names.
constexpr std::array<hb_tag_t, 5> kUnneeded = {
    HB_TAG('G', 'S', 'U', 'B'), HB_TAG('G', 'P', 'O', 'S'), HB_TAG('G', 'D', 'E', 'F'),
    HB_TAG('k', 'e', 'r', 'n'), HB_TAG('n', 'a', 'm', 'e')};

tl::unexpected<Error> failure() {
  return fail(Code::kInternal,
              "font: cannot be reduced to the characters of a page. Reinstall the Debian packages "
              "fonts-dejavu-core and libharfbuzz-subset0");
}

}  // namespace

Result<FontSubset> make_subset(const Font& font, const std::set<std::uint32_t>& glyphs) {
  const std::string& whole = font.file();
  const Blob blob(hb_blob_create(whole.data(), static_cast<unsigned>(whole.size()),
                                 HB_MEMORY_MODE_READONLY, nullptr, nullptr));
  const Face face(hb_face_create(blob.get(), 0));
  const Input input(hb_subset_input_create_or_fail());
  if (!input) return failure();
  hb_subset_input_set_flags(input.get(),
                            HB_SUBSET_FLAGS_NO_HINTING | HB_SUBSET_FLAGS_NOTDEF_OUTLINE);
  for (const std::uint32_t glyph : glyphs) {
    hb_set_add(hb_subset_input_glyph_set(input.get()), glyph);
  }
  for (const hb_tag_t tag : kUnneeded) {
    hb_set_add(hb_subset_input_set(input.get(), HB_SUBSET_SETS_DROP_TABLE_TAG), tag);
  }
  const Plan plan(hb_subset_plan_create_or_fail(face.get(), input.get()));
  if (!plan) return failure();
  const Face subset(hb_subset_plan_execute_or_fail(plan.get()));
  if (!subset) return failure();

  FontSubset out;
  const hb_map_t* const numbers = hb_subset_plan_old_to_new_glyph_mapping(plan.get());
  for (const std::uint32_t glyph : glyphs) {
    if (!hb_map_has(numbers, glyph)) return failure();
    out.glyphs[glyph] = hb_map_get(numbers, glyph);
  }
  const Blob bytes(hb_face_reference_blob(subset.get()));
  unsigned length = 0;
  const char* const data = hb_blob_get_data(bytes.get(), &length);
  if (data == nullptr || length == 0) return failure();
  out.file.assign(data, length);
  return out;
}

}  // namespace hydroprint::text
