#include "hardware/drive/block_parts.h"

#include <algorithm>
#include <optional>

namespace hydroprint::drive {
namespace {

/// First register and register after the last one.
struct Span {
  int begin = 0;
  int end = 0;
};

Span of(const Field& field) { return {field.address, field.address + field.format.words}; }

bool has_count(const DriveProfile& profile, int count) {
  return std::any_of(profile.blocks.begin(), profile.blocks.end(),
                     [&](const Block& other) { return other.count == count; });
}

bool is_in(const Block& block, Space space, const Span& span) {
  return block.space == space && block.address <= span.begin &&
         span.end <= block.address + block.count;
}

/// Returns what must not be separated: numbers, and position with velocity.
std::vector<Span> whole_spans(const DriveProfile& profile, const Block& block) {
  std::vector<Span> out;
  const auto add = [&](Space space, const Span& span) {
    if (is_in(block, space, span)) out.push_back(span);
  };
  add(profile.position.space, of(profile.position));
  if (profile.demand) add(profile.demand->space, of(*profile.demand));
  if (!profile.velocity) return out;
  const Span position = of(profile.position);
  const Span velocity = of(*profile.velocity);
  add(profile.velocity->space, velocity);
  if (profile.position.space == profile.velocity->space) {
    add(profile.position.space,
        {std::min(position.begin, velocity.begin), std::max(position.end, velocity.end)});
  }
  return out;
}

/// Returns all registers of the block that the profile uses.
Span used_span(const DriveProfile& profile, const Block& block) {
  Span out{block.mark.address, block.mark.address + 1};
  const auto add = [&](Space space, const Span& span) {
    if (!is_in(block, space, span)) return;
    out = {std::min(out.begin, span.begin), std::max(out.end, span.end)};
  };
  for (const Span& span : whole_spans(profile, block)) add(block.space, span);
  add(profile.alarm_code.space, {profile.alarm_code.address, profile.alarm_code.address + 1});
  for (const auto& bit : profile.bits) {
    if (bit) add(bit->space, {bit->address, bit->address + 1});
  }
  return out;
}

Part part(int begin, int end) {
  return {static_cast<std::uint16_t>(begin), static_cast<std::uint16_t>(end - begin)};
}

/// Returns the first cut that leaves at least `least` words on both sides.
std::optional<int> find_cut(const DriveProfile& profile, const Block& block, int least) {
  const auto spans = whole_spans(profile, block);
  for (int first = least; block.count - first >= least; ++first) {
    const int second = block.count - first;
    const int cut = block.address + first;
    const bool separates = std::any_of(spans.begin(), spans.end(), [&](const Span& span) {
      return span.begin < cut && cut < span.end;
    });
    if (!separates && first != second && !has_count(profile, first) && !has_count(profile, second))
      return cut;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Part> parts_of(const DriveProfile& profile, const Block& block) {
  const int end = block.address + block.count;
  // Identity and watchdog are read with one or two words.
  for (const int least : {3, 1}) {
    if (const auto cut = find_cut(profile, block, least)) {
      return {part(block.address, *cut), part(*cut, end)};
    }
  }
  const Span used = used_span(profile, block);
  if (has_count(profile, used.end - used.begin)) return {};
  return {part(used.begin, used.end)};
}

}  // namespace hydroprint::drive
