#include "proto/warning_message.h"

#include "sim/base/utf8.h"

namespace hydroprint {
namespace {

/// Sets each kind of place.
struct SetPlace {
  v1::Place& out;

  void operator()(std::monostate /*none*/) const {}
  void operator()(const FilmPoint& point) const {
    v1::Place::FilmPoint& message = *out.mutable_film_point();
    message.set_x_mm(point.x_mm);
    message.set_y_mm(point.y_mm);
    message.set_immersion_mm(point.immersion_mm);
  }
  void operator()(const OnSurface& /*all*/) const { out.set_surface(true); }
  void operator()(const AtImmersion& at) const { out.set_immersion_mm(at.immersion_mm); }
  void operator()(const InFile& file) const {
    out.mutable_file()->set_name(valid_utf8(file.name));
    out.mutable_file()->set_line(file.line);
  }
  void operator()(const InLayer& layer) const { out.set_layer(valid_utf8(layer.name)); }
  void operator()(const OnSheet& sheet) const { out.set_sheet(sheet.number); }
  void operator()(const AtMarker& marker) const { out.set_marker(valid_utf8(marker.name)); }
  void operator()(const OfResource& resource) const { out.set_resource(valid_utf8(resource.name)); }
  void operator()(const OfItem& item) const { out.set_item(valid_utf8(item.name)); }
};

Place place_of(const v1::Place& message) {
  const int dip = message.dip();
  switch (message.place_case()) {
    case v1::Place::kFilmPoint:
      return {FilmPoint{message.film_point().x_mm(), message.film_point().y_mm(),
                        message.film_point().immersion_mm()},
              dip};
    case v1::Place::kSurface:
      return {OnSurface{}, dip};
    case v1::Place::kImmersionMm:
      return {AtImmersion{message.immersion_mm()}, dip};
    case v1::Place::kFile:
      return {InFile{message.file().name(), message.file().line()}, dip};
    case v1::Place::kLayer:
      return {InLayer{message.layer()}, dip};
    case v1::Place::kSheet:
      return {OnSheet{message.sheet()}, dip};
    case v1::Place::kMarker:
      return {AtMarker{message.marker()}, dip};
    case v1::Place::kResource:
      return {OfResource{message.resource()}, dip};
    case v1::Place::kItem:
      return {OfItem{message.item()}, dip};
    case v1::Place::PLACE_NOT_SET:
      break;
  }
  return {{}, dip};
}

}  // namespace

v1::Warning to_message(const Warning& warning) {
  v1::Warning out;
  out.set_code(static_cast<v1::Warning::Code>(warning.code));
  out.set_message(valid_utf8(warning.message));
  const Place& where = warning.where;
  if (std::holds_alternative<std::monostate>(where.place) && where.dip == 0) return out;
  out.mutable_where()->set_dip(where.dip);
  std::visit(SetPlace{*out.mutable_where()}, where.place);
  return out;
}

void add_warnings(const Warnings& warnings,
                  google::protobuf::RepeatedPtrField<v1::Warning>& messages) {
  for (const Warning& warning : warnings) *messages.Add() = to_message(warning);
}

Warning to_warning(const v1::Warning& message) {
  return {static_cast<WarningCode>(message.code()), message.message(), place_of(message.where())};
}

std::string text_of(const v1::Warning& warning) {
  const std::string where = words_of(place_of(warning.where()));
  return one_line(where.empty() ? warning.message() : warning.message() + " (" + where + ")");
}

}  // namespace hydroprint
