#include "sim/print/placement.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/image/figures/pictures.h"
#include "sim/print/marks.h"
#include "sim/print/page_text.h"
#include "sim/text/font.h"
#include "sim/waterline/body.h"
#include "sim/waterline/cross_section.h"
#include "sim/waterline/slicer.h"

namespace hydroprint::print {
namespace {

using Eigen::Vector2d;
using Strokes = std::vector<Stroke>;

constexpr double kSlice_mm = 0.5;  ///< distance between the cuts that form the silhouette
constexpr int kMostSlices = 400;
constexpr double kBold_mm = 0.6, kThin_mm = 0.15, kLine_mm = 0.25;

Vector2d turned(const Vector2d& size_mm) { return {size_mm.y(), size_mm.x()}; }

/// Returns the size of the paper in the orientation in which the film fits.
Result<Vector2d> sheet_for(const film::Outline& outline, const PageSettings& settings) {
  for (const Vector2d& size_mm : {settings.paper_mm, turned(settings.paper_mm)}) {
    if ((size_mm - outline.size_mm()).minCoeff() >= -1e-6) return size_mm;
  }
  return fail(Code::kOutOfRange, "paper: smaller than the film " + outline.name +
                                     ". Use paper of the film's size or larger");
}

/// Returns the outline, seen from above, of the part of the object up to `height_mm` above its
/// lowest point.
waterline::CrossSection silhouette(const waterline::Slicer& slicer, double height_mm) {
  const int slices = std::clamp(static_cast<int>(height_mm / kSlice_mm), 1, kMostSlices);
  std::vector<waterline::Contour> all;
  for (int i = 0; i < slices; ++i) {
    auto contours = slicer.cut(height_mm * (i + 0.5) / slices);
    std::move(contours.begin(), contours.end(), std::back_inserter(all));
  }
  return waterline::unite(all);
}

Strokes outlines(const waterline::CrossSection& section, const Vector2d& origin_mm, double width_mm,
                 double ink) {
  Strokes out;
  for (const waterline::Loop& loop : section) {
    Stroke stroke{{}, width_mm, ink};
    for (const Vector2d& p : loop.points_mm) stroke.points_mm.push_back(origin_mm + p);
    if (!stroke.points_mm.empty()) stroke.points_mm.push_back(stroke.points_mm.front());
    out.push_back(std::move(stroke));
  }
  return out;
}

Box box_round(const waterline::CrossSection& section) {
  Box box{Vector2d::Constant(HUGE_VAL), Vector2d::Constant(-HUGE_VAL)};
  for (const waterline::Loop& loop : section) {
    for (const Vector2d& p : loop.points_mm) {
      box.low_mm = box.low_mm.cwiseMin(p);
      box.high_mm = box.high_mm.cwiseMax(p);
    }
  }
  return box;
}

void append(Page& page, Drawing drawing) { append(page.strokes, page.texts, std::move(drawing)); }

/// Draws both axes across the whole film, with a tick every 10 mm and a longer one every 50 mm.
Drawing axes(const film::Outline& outline, const Vector2d& origin_mm) {
  Drawing out;
  for (int axis = 0; axis < 2; ++axis) {
    const Vector2d along = Vector2d::Unit(axis), across = Vector2d::Unit(1 - axis);
    const double low = outline.min_mm[axis], high = outline.max_mm[axis];
    out.strokes.push_back({{origin_mm + low * along, origin_mm + high * along}, kThin_mm, 0.6});
    const long last = std::lround(std::floor(high / 10));
    for (long tick = std::lround(std::ceil(low / 10)); tick <= last; ++tick) {
      const double at = 10 * static_cast<double>(tick);
      const double half = tick % 5 == 0 ? 2 : 1;
      out.strokes.push_back(
          {{origin_mm + at * along - half * across, origin_mm + at * along + half * across},
           kThin_mm,
           0.6});
    }
    const Vector2d end =
        origin_mm + high * along - (axis == 0 ? Vector2d(6, -2.5) : Vector2d(-2.5, 6));
    out.texts.push_back({axis == 0 ? "+x" : "+y", end, kLetter_mm, 1});
  }
  return out;
}

Stroke film_edge(const film::Outline& outline, const Vector2d& origin_mm) {
  Stroke out{{}, kLine_mm, 0.6};
  for (const Vector2d& p : outline.polygon) out.points_mm.push_back(origin_mm + p);
  out.points_mm.push_back(out.points_mm.front());
  return out;
}

/// Returns a cross with a gap, so that the point itself stays visible.
Strokes cross(const Vector2d& at_mm) {
  Strokes out;
  for (const Vector2d& way : {Vector2d(1, 0), Vector2d(-1, 0), Vector2d(0, 1), Vector2d(0, -1)}) {
    out.push_back({{at_mm + 0.7 * way, at_mm + 4 * way}, kLine_mm, 1});
  }
  return out;
}

/// Returns the text beside the drawing. Adding 0.0 turns -0 into 0.
std::vector<std::string> lines_of(const Placement& placement, const PageSettings& settings) {
  const Eigen::Quaterniond q(placement.X_FO.linear());
  const Eigen::Vector3d& t = placement.X_FO.translation();
  std::vector<std::string> out;
  if (!settings.job_name.empty()) out.push_back(settings.job_name);
  if (!settings.date.empty()) out.push_back(settings.date);
  out.emplace_back("placement, seen from above");
  out.emplace_back("bold: first contact, middle");
  out.push_back(fmt::format("x {:.2f}  y {:.2f} mm", placement.contact_mm.x() + 0.0,
                            placement.contact_mm.y() + 0.0));
  out.emplace_back("grey: all of the object");
  out.push_back(fmt::format("wxyz {:.2f} {:.2f} {:.2f} {:.2f}", q.w() + 0.0, q.x() + 0.0,
                            q.y() + 0.0, q.z() + 0.0));
  out.push_back(fmt::format("origin x {:.2f}  y {:.2f} mm", t.x() + 0.0, t.y() + 0.0));
  return out;
}

/// Places text and the ruler in the free space around the object.
class Legend {
 public:
  Legend(Page& page, const text::Font& font, const Box& printable,
         const waterline::CrossSection& object, const Vector2d& origin_mm)
      : page_(page), font_(font), printable_(printable), space_(printable) {
    for (const waterline::Loop& loop : object) {
      if (loop.is_hole) continue;
      std::vector<Vector2d> polygon;
      for (const Vector2d& p : loop.points_mm) polygon.push_back(origin_mm + p);
      space_.take(polygon, 2);
    }
    for (const Vector2d& way : {Vector2d(3, 4000), Vector2d(4000, 3)}) {  // the axes
      space_.take(Box{origin_mm - way, origin_mm + way});
    }
  }

  [[nodiscard]] bool add_ruler() {
    for (const double length_mm : {100.0, 50.0}) {
      const Vector2d near(printable_.low_mm.x(), printable_.low_mm.y());
      const auto box = space_.find(ruler_size_mm(length_mm, false), near);
      if (!box) continue;
      append(page_, ruler(box->low_mm, length_mm, false));
      space_.take(*box);
      return true;
    }
    return false;
  }

  /// Returns the placed text; nullopt if there was no space.
  [[nodiscard]] std::optional<TextBlock> add_text(const std::vector<std::string>& lines) {
    const auto of_width = [&](double width) {
      std::vector<std::string> out;
      for (const std::string& line : lines) out.push_back(font_.shortened(line, width));
      return out;
    };
    const Vector2d near(printable_.low_mm.x(), printable_.high_mm.y());
    auto block = place_text(font_, of_width,
                            [&](const Vector2d& size_mm) { return space_.find(size_mm, near); });
    if (!block) return std::nullopt;
    append(page_, {{}, block->texts});
    space_.take(block->box);
    return block;
  }

 private:
  Page& page_;
  const text::Font& font_;
  Box printable_;
  FreeSpace space_;
};

/// Draws the views of `simulate`'s pictures for an object without colours.
Result<Page> orientation_page(const mesh::Surface& surface, const Pose& X_FO,
                              const Vector2d& size_mm, const film::Outline& outline,
                              double margin_mm, const Context& context) {
  const image::RgbImage white{1, 1, {255, 255, 255}};
  HP_ASSIGN_OR_RETURN(const auto film, image::FilmTexture::from_image(white, outline, 1, context));
  HP_ASSIGN_OR_RETURN(const auto views, image::find_views(surface, X_FO, {}, context));
  HP_ASSIGN_OR_RETURN(image::RgbImage picture, image::predicted_picture(views, film, context));
  Page page;
  page.size_mm = size_mm;
  const Vector2d room = size_mm - Vector2d::Constant(2 * std::max(margin_mm, 10.0));
  const double pitch_mm = std::min(room.x() / picture.width, room.y() / picture.height);
  const Vector2d drawn = Vector2d(picture.width, picture.height) * pitch_mm;
  page.images.push_back({{picture.width, picture.height, 3, std::move(picture.rgb)},
                         pitch_mm,
                         (size_mm - drawn) / 2});
  return page;
}

Status check_contact(const waterline::CrossSection& contact, const film::Outline& outline) {
  std::vector<std::vector<Vector2d>> solid;
  for (const waterline::Loop& loop : contact) solid.push_back(loop.points_mm);
  if (!solid.empty() && waterline::common_area({outline.polygon}, solid) > 0) return {};
  return fail_field(Code::kFailedPrecondition, "pose",
                    "the object's first contact misses the film " + outline.name +
                        ". Move the object over the film, or use a larger film",
                    ErrorReason::CONTACT_MISSES_FILM);
}

}  // namespace

Result<Placement> placement(const mesh::Surface& surface, const std::optional<Pose>& X_FO,
                            const film::Outline& outline, const PageSettings& settings,
                            const Context& context) {
  HP_RETURN_IF_ERROR(check(settings));
  HP_ASSIGN_OR_RETURN(const text::Font* const font, text::Font::standard());
  Page page;
  HP_ASSIGN_OR_RETURN(page.size_mm, sheet_for(outline, settings));
  Placement out;
  out.X_FO = X_FO.value_or(waterline::centred_pose(surface));
  const waterline::Body body = waterline::place(surface, out.X_FO);
  const waterline::Slicer slicer(body);
  const auto contact = waterline::unite(slicer.cut(std::min(kFirstContact_mm, body.height_mm / 2)));
  HP_RETURN_IF_ERROR(check_contact(contact, outline));
  const waterline::CrossSection object = silhouette(slicer, body.height_mm);
  HP_RETURN_IF_ERROR(check_cancelled(context));
  const Box touched = box_round(contact);
  out.contact_mm = (touched.low_mm + touched.high_mm) / 2;
  out.contact_size_mm = touched.size_mm();

  const Vector2d origin_mm = page.size_mm / 2 - (outline.min_mm + outline.max_mm) / 2;
  page.strokes.push_back(film_edge(outline, origin_mm));
  append(page, axes(outline, origin_mm));
  append(page, {outlines(object, origin_mm, kLine_mm, 0.5), {}});
  append(page, {outlines(contact, origin_mm, kBold_mm, 1), {}});
  append(page, {cross(origin_mm + out.contact_mm), {}});
  const Vector2d margin = Vector2d::Constant(std::max(settings.printer_margin_mm, 4.0));
  Legend legend(page, *font, {margin, page.size_mm - margin}, object, origin_mm);
  const bool has_ruler = legend.add_ruler();
  const auto text = legend.add_text(lines_of(out, settings));
  if (text && text->is_shortened) warn_of_shortened_text({OnSheet{1}}, out.warnings);
  warn_of_missing_glyphs(*font, page.texts, {OnSheet{1}}, out.warnings);
  if (!has_ruler || !text) {
    out.warnings.push_back(
        {WarningCode::TEMPLATE_CUT_OFF,
         "the ruler or the text is left out, because there is not enough room beside the "
         "object. Use larger paper",
         {OnSheet{1}}});
  }
  HP_ASSIGN_OR_RETURN(Page pictures, orientation_page(surface, out.X_FO, page.size_mm, outline,
                                                      settings.printer_margin_mm, context));
  out.document.title = settings.job_name.empty() ? "Placement template" : settings.job_name;
  out.document.pages = {std::move(page), std::move(pictures)};
  return out;
}

}  // namespace hydroprint::print
