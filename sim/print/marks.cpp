#include "sim/print/marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "sim/print/page_text.h"

namespace hydroprint::print {
namespace {

using Eigen::Vector2d;
using Strokes = std::vector<Stroke>;

constexpr double kPen_mm = 0.25;
constexpr double kClearance_mm = 1;  ///< distance of marks from the film
constexpr double kOff_mm = 2;      ///< distance of registration, corner and join marks from an edge
constexpr double kMark_mm = 5;     ///< length of a registration, corner or join mark
constexpr double kBleed_mm = 0.5;  ///< free space around the arrow

Stroke line(const Vector2d& from_mm, const Vector2d& to_mm) {
  return {{from_mm, to_mm}, kPen_mm, 1};
}

Box box_of(const Strokes& strokes) {
  Box box{Vector2d::Constant(HUGE_VAL), Vector2d::Constant(-HUGE_VAL)};
  for (const Stroke& stroke : strokes) {
    for (const Vector2d& point : stroke.points_mm) {
      const Vector2d half = Vector2d::Constant(stroke.width_mm / 2);
      box.low_mm = box.low_mm.cwiseMin(point - half);
      box.high_mm = box.high_mm.cwiseMax(point + half);
    }
  }
  return box;
}

/// Draws marks on a sheet while there is space.
class Marker {
 public:
  Marker(Sheet& sheet, const Box& printable) : sheet_(sheet), space_(printable) {
    space_.take(sheet.film_mm, kClearance_mm);
  }

  /// Draws marks at fixed positions; those without space are dropped.
  void draw_fixed(const std::string& name, const Strokes& strokes) {
    bool all = true;
    for (const Stroke& stroke : strokes) {
      const Box box = box_of({stroke});
      if (!space_.is_free(box)) {
        all = false;
        continue;
      }
      sheet_.marks.push_back(stroke);
      pending_.push_back(box);
    }
    note(name, all);
  }

  /// Finds space for a mark that may be anywhere; nullopt if there is none.
  [[nodiscard]] std::optional<Box> find_room(const Vector2d& size_mm, const Vector2d& near_mm) {
    settle();
    return space_.find(size_mm, near_mm);
  }
  /// Draws a mark in the space that was found for it.
  void draw(const Box& room, Drawing mark) {
    append(sheet_.marks, sheet_.texts, std::move(mark));
    pending_.push_back(room);
  }
  void note_shortened_text() { sheet_.is_text_shortened = true; }

  void note(const std::string& name, bool drawn) {
    (drawn ? sheet_.drawn : sheet_.dropped).push_back(name);
  }

 private:
  /// Marks at fixed positions may touch each other; other marks keep a distance from all of them.
  void settle() {
    for (const Box& box : pending_) {
      const Vector2d around = Vector2d::Constant(kClearance_mm);
      space_.take(Box{box.low_mm - around, box.high_mm + around});
    }
    pending_.clear();
  }

  Sheet& sheet_;
  FreeSpace space_;
  std::vector<Box> pending_;
};

Vector2d middle_of(const Box& box) { return (box.low_mm + box.high_mm) / 2; }

/// Returns marks outside a box: below and above it at the given x, and to its left and right at the
/// given y. These x and y are relative to the box's middle.
Strokes side_marks(const Box& box, const std::vector<double>& at_x,
                   const std::vector<double>& at_y) {
  Strokes out;
  for (int axis = 0; axis < 2; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      for (const double at : axis == 0 ? at_x : at_y) {
        Vector2d from, to;
        from[axis] = to[axis] = at;
        from[1 - axis] = side * (box.size_mm()[1 - axis] / 2 + kOff_mm);
        to[1 - axis] = from[1 - axis] + side * kMark_mm;
        out.push_back(line(middle_of(box) + from, middle_of(box) + to));
      }
    }
  }
  return out;
}

/// Returns marks at the middle of each side, where a sliding bar is, and at both ends of the bar.
Strokes bar_marks(const Box& film, double bar_mm) {
  std::vector<double> along = {0};
  if (bar_mm > 0) along = {-bar_mm / 2, 0, bar_mm / 2};
  return side_marks(film, along, along);
}

/// Returns marks that extend both edges beyond each corner of a box.
Strokes corner_marks(const Box& box) {
  const Vector2d half = box.size_mm() / 2;
  return side_marks(box, {-half.x(), half.x()}, {-half.y(), half.y()});
}

/// Returns marks at the edges of the neighbours' windows, along the sides of this window.
Strokes join_marks(const MarkPlan& plan) {
  const Vector2d middle = middle_of(plan.window);
  std::vector<double> at_x = plan.joins_x_mm, at_y = plan.joins_y_mm;
  for (double& x : at_x) x -= middle.x();
  for (double& y : at_y) y -= middle.y();
  return side_marks(plan.window, at_x, at_y);
}

/// Removes marks for parts of the film that are on other sheets.
Strokes on_this_sheet(Strokes marks, const Box& window) {
  std::erase_if(marks, [&](const Stroke& mark) {
    const Vector2d off = Vector2d::Constant(kOff_mm + kClearance_mm);
    const Vector2d& from = mark.points_mm.front();
    return (from - window.low_mm + off).minCoeff() < 0 ||
           (window.high_mm + off - from).minCoeff() < 0;
  });
  return marks;
}

/// Length of the arrow to the film's +y, which points up and has a label beside it.
constexpr double kArrow_mm = 12;
constexpr double kArrowText_mm = 3.5;  ///< distance from the arrow to its label
const Vector2d kArrowFoot_mm(2.5, kBleed_mm);

Drawing arrow(const Vector2d& low_mm) {
  const Vector2d foot = low_mm + kArrowFoot_mm;
  const Vector2d tip = foot + Vector2d(0, kArrow_mm);
  const Vector2d text = foot + Vector2d(kArrowText_mm, kArrow_mm / 2 - kLetter_mm / 2);
  return {{{{foot, tip}, 2 * kPen_mm, 1},
           {{tip + Vector2d(-2, -3.5), tip, tip + Vector2d(2, -3.5)}, 2 * kPen_mm, 1}},
          {{"top +y", text, kLetter_mm, 1}}};
}

void add_arrow(Marker& marker, const Box& printable, const text::Font& font) {
  const Box text = text_box(font, arrow(Vector2d::Zero()).texts.front());
  const Vector2d size_mm(text.high_mm.x() + kBleed_mm, kArrow_mm + 2 * kBleed_mm);
  const auto room = marker.find_room(size_mm, printable.high_mm);
  if (room) marker.draw(*room, arrow(room->low_mm));
  marker.note("arrow", room.has_value());
}

void add_ruler(Marker& marker, const Box& printable, bool upright) {
  const Vector2d middle = (printable.low_mm + printable.high_mm) / 2;
  const Vector2d near = upright ? Vector2d(printable.low_mm.x(), middle.y())
                                : Vector2d(middle.x(), printable.low_mm.y());
  for (const double length_mm : {200.0, 150.0, 100.0, 50.0}) {
    const auto room = marker.find_room(ruler_size_mm(length_mm, upright), near);
    if (!room) continue;
    marker.draw(*room, ruler(room->low_mm, length_mm, upright));
    return marker.note(upright ? "upright ruler" : "ruler", true);
  }
  marker.note(upright ? "upright ruler" : "ruler", false);
}

/// Returns the job name and the details on one line of at most `width` (in heights of a
/// lower-case x).
std::string text_line(const MarkPlan& plan, const text::Font& font, double width) {
  if (plan.job_name.empty()) return font.shortened(plan.details, width);
  const std::string rest = plan.details.empty() ? "" : "  " + plan.details;
  const std::string name = font.shortened(plan.job_name, width - font.lay_out(rest).width);
  return name.empty() ? font.shortened(plan.job_name + rest, width) : name + rest;
}

void add_text(Marker& marker, const MarkPlan& plan, const text::Font& font) {
  const Box& printable = plan.printable;
  const Vector2d near((printable.low_mm.x() + printable.high_mm.x()) / 2, printable.high_mm.y());
  const auto lines = [&](double width) {
    return std::vector<std::string>{text_line(plan, font, width)};
  };
  auto block = place_text(font, lines,
                          [&](const Vector2d& size_mm) { return marker.find_room(size_mm, near); });
  marker.note("text", block.has_value());
  if (!block) return;
  if (block->is_shortened) marker.note_shortened_text();
  marker.draw(block->box, {{}, std::move(block->texts)});
}

}  // namespace

Vector2d ruler_size_mm(double length_mm, bool upright) {
  const Vector2d lying(length_mm + 12, 8);
  return upright ? Vector2d(12, length_mm + 6) : lying;
}

Drawing ruler(const Vector2d& low_mm, double length_mm, bool upright) {
  const Vector2d zero = low_mm + (upright ? Vector2d(0.5, 3) : Vector2d(2, 0.5));
  const Vector2d along = upright ? Vector2d::UnitY() : Vector2d::UnitX();
  const Vector2d across = upright ? Vector2d::UnitX() : Vector2d::UnitY();
  Drawing out{{line(zero, zero + length_mm * along)}, {}};
  const int ticks = static_cast<int>(std::lround(length_mm / 10));
  for (int i = 0; i <= ticks; ++i) {
    const Vector2d at = zero + 10.0 * i * along;
    out.strokes.push_back(line(at, at + (i % 5 == 0 ? 3.5 : 2.0) * across));
  }
  const auto label = [&](const std::string& text, double at_mm) {
    const Vector2d at = upright ? zero + Vector2d(4.5, at_mm - kLetter_mm / 2)
                                : zero + Vector2d(at_mm - 0.5 * kLetter_mm, 4.6);
    out.texts.push_back({text, at, upright ? 0.8 : 1.1, 1});
  };
  label("0", 0);
  label(fmt::format("{} mm", static_cast<int>(length_mm)), length_mm);
  return out;
}

void append(Strokes& strokes, std::vector<Text>& texts, Drawing drawing) {
  std::move(drawing.strokes.begin(), drawing.strokes.end(), std::back_inserter(strokes));
  std::move(drawing.texts.begin(), drawing.texts.end(), std::back_inserter(texts));
}

void add_marks(Sheet& sheet, const MarkPlan& plan, const text::Font& font) {
  Marker marker(sheet, plan.printable);
  const bool is_part = !plan.joins_x_mm.empty() || !plan.joins_y_mm.empty();
  const auto here = [&](Strokes marks) {
    return is_part ? on_this_sheet(std::move(marks), plan.window) : marks;
  };
  marker.draw_fixed("registration marks", here(bar_marks(plan.film, plan.bar_mm)));
  marker.draw_fixed("corner marks", corner_marks(plan.window));
  if (is_part) marker.draw_fixed("join marks", join_marks(plan));
  add_ruler(marker, plan.printable, false);
  add_ruler(marker, plan.printable, true);
  add_arrow(marker, plan.printable, font);
  if (!plan.job_name.empty() || !plan.details.empty()) add_text(marker, plan, font);
}

}  // namespace hydroprint::print
