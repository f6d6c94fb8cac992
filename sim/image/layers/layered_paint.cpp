#include "sim/image/layers/layered_paint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "sim/image/io/colour.h"

namespace hydroprint::image {
namespace {

/// Decodes the veil of a picture: black, shown over white.
Decoding veil_decoding() {
  Decoding out;
  out.tint = Eigen::Vector3f::Zero();
  return out;
}

/// The textures of a picture.
struct Pictures {
  std::shared_ptr<const Texture> picture, veil;
};

class LayerLoader {
 public:
  LayerLoader(const mesh::Model& model, const Eigen::Matrix3d& R_FO, const Context& context)
      : model_(model), R_FO_(R_FO), context_(context) {}

  Result<LayeredPaint> load(const PaintSource& source) {
    out_.base_colour = linear_from_srgb(source.base_colour);
    over_white_ = out_.base_colour.isOnes();
    for (const Layer& layer : source.layers) {
      HP_ASSIGN_OR_RETURN(LoadedLayer loaded, load(layer));
      out_.layers.push_back(std::move(loaded));
      over_white_ = false;
    }
    return std::move(out_);
  }

 private:
  Result<LoadedLayer> load(const Layer& layer) {
    LoadedLayer out;
    out.name = layer.name;
    out.projection = layer.projection ? *layer.projection : usual_projection(layer);
    out.opacity = static_cast<float>(layer.opacity);
    if (layer.colour) out.colour = linear_from_srgb(*layer.colour);
    if (out.projection == Projection::kVertexColours) return load_surface(std::move(out));
    if (out.projection == Projection::kUv) return load_uv(layer, std::move(out));
    return load_projected(layer, std::move(out));
  }

  Projection usual_projection(const Layer& layer) {
    if (!model_.corner_uvs.empty() || (layer.picture.empty() && !layer.colour))
      return Projection::kUv;
    if (!layer.picture.empty()) {
      out_.warnings.push_back(
          {WarningCode::PICTURE_PROJECTED,
           fmt::format("{} has no texture coordinates, so the picture is projected along the dip, "
                       "as the film sees the object. Choose another projection if the "
                       "sides should look different",
                       model_.path.filename().string()),
           {InLayer{layer.name}}});
    }
    return Projection::kDip;
  }

  Result<LoadedLayer> load_surface(LoadedLayer out) {
    if (model_.vertex_colours.empty() && model_.triangle_colours.empty()) {
      return fail(Code::kInvalidArgument,
                  fmt::format("layer {}: {} has no colours of vertices or triangles. Choose "
                              "another projection",
                              out.name, model_.path.string()));
    }
    out.own = std::make_shared<Paint>(load_surface_colours(model_));
    return out;
  }

  Result<LoadedLayer> load_uv(const Layer& layer, LoadedLayer out) {
    if (layer.picture.empty() && layer.colour) return out;
    if (layer.picture.empty()) {
      HP_ASSIGN_OR_RETURN(Paint own, load_paint(model_, std::nullopt, context_));
      add(own.warnings());
      out.own = std::make_shared<Paint>(std::move(own));
      return out;
    }
    TextureUse use;
    use.repeats = layer.repeat.value_or(true);
    HP_ASSIGN_OR_RETURN(Paint own, load_paint(model_, layer.picture, context_, use));
    add_unless_veiled(own.warnings());
    const bool shows_below = own.shows_white() && !over_white_;
    out.own = std::make_shared<Paint>(std::move(own));
    if (!shows_below) return out;
    use.decoding = veil_decoding();
    HP_ASSIGN_OR_RETURN(Paint veil, load_paint(model_, layer.picture, context_, use));
    out.own_veil = std::make_shared<Paint>(std::move(veil));
    return out;
  }

  Result<LoadedLayer> load_projected(const Layer& layer, LoadedLayer out) {
    double aspect = 1;
    if (!layer.picture.empty()) {
      const bool upright =
          out.projection == Projection::kCylindrical || out.projection == Projection::kBox;
      const bool repeats = layer.repeat.value_or(upright);
      HP_ASSIGN_OR_RETURN(const Pictures read, pictures(layer.picture, repeats));
      out.picture = read.picture;
      out.veil = read.veil;
      aspect = static_cast<double>(out.picture->width()) / out.picture->height();
    }
    HP_ASSIGN_OR_RETURN(out.placement, place(layer, out.projection, model_, R_FO_, aspect));
    for (int axis = 0; axis < 3; ++axis)
      out.planes[static_cast<std::size_t>(axis)] = out.placement.plane(axis);
    return out;
  }

  /// Reads a picture once for all layers that use it in the same way.
  Result<Pictures> pictures(const std::filesystem::path& path, bool repeats) {
    const auto key = std::tuple(path, repeats, over_white_);
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
    const mesh::Wrap wrap = repeats ? mesh::Wrap::kRepeat : mesh::Wrap::kClamp;
    Pictures out;
    HP_ASSIGN_OR_RETURN(ReadImage read, read_image(path, context_));
    HP_RETURN_IF_ERROR(count(read, path));
    add(read.warnings);
    const bool shows_below = read.had_alpha && !over_white_;
    HP_ASSIGN_OR_RETURN(out.picture, texture(std::move(read), wrap));
    if (shows_below) {
      HP_ASSIGN_OR_RETURN(ReadImage veil, read_image(path, context_, veil_decoding()));
      HP_RETURN_IF_ERROR(count(veil, path));
      HP_ASSIGN_OR_RETURN(out.veil, texture(std::move(veil), wrap));
    }
    known_.emplace(key, out);
    return out;
  }

  Result<std::shared_ptr<const Texture>> texture(ReadImage read, mesh::Wrap wrap) {
    HP_ASSIGN_OR_RETURN(Texture built, Texture::build(std::move(read.image), wrap, wrap, context_));
    return std::make_shared<const Texture>(std::move(built));
  }

  Status count(const ReadImage& read, const std::filesystem::path& path) {
    area_px_ += static_cast<std::int64_t>(read.image.texels.size());
    if (area_px_ <= kMaxImageArea_px) return {};
    return fail(Code::kOutOfRange,
                fmt::format("{}: the paint's pictures together have more than {} million pixels "
                            "(those with transparency count twice). Scale them down",
                            path.string(), kMaxImageArea_px / 1'000'000));
  }

  void add(const Warnings& more) {
    out_.warnings.insert(out_.warnings.end(), more.begin(), more.end());
  }

  /// Adds warnings, except that a transparent picture shows white where a veil shows the layers
  /// below.
  void add_unless_veiled(const Warnings& more) {
    for (const Warning& warning : more) {
      const bool is_of_white = warning.code == WarningCode::ALPHA_OVER_WHITE ||
                               warning.code == WarningCode::UVS_MISSING_IN_PART;
      if (over_white_ || !is_of_white) out_.warnings.push_back(warning);
    }
  }

  const mesh::Model& model_;
  const Eigen::Matrix3d& R_FO_;
  const Context& context_;
  LayeredPaint out_;
  bool over_white_ = true;  ///< nothing but white is below the layer
  std::int64_t area_px_ = 0;
  std::map<std::tuple<std::filesystem::path, bool, bool>, Pictures> known_;
};

bool shows_colour(const LoadedLayer& layer) {
  if (layer.opacity <= 0) return false;
  if (layer.own) return layer.own->has_colour();
  return layer.picture || !layer.colour.isOnes();
}

}  // namespace

bool LoadedLayer::is_opaque() const {
  return opacity >= 1 && !veil && !own_veil && projection != Projection::kDecal;
}

bool LayeredPaint::has_colour() const {
  return !base_colour.isOnes() || std::ranges::any_of(layers, shows_colour);
}

Result<LayeredPaint> load_layers(const mesh::Model& model, const PaintSource& source,
                                 const Eigen::Matrix3d& R_FO, const Context& context) {
  return LayerLoader(model, R_FO, context).load(source);
}

}  // namespace hydroprint::image
