#pragma once

#include <cstddef>

namespace hydroprint::image {

/// Places of an image's pixels after it is turned as its Exif orientation says (Exif 2.3, tag 274).
class Turned {
 public:
  /// @param orientation  1 to 8; other values turn nothing
  /// @param width,height  as stored
  Turned(int orientation, int width, int height) : width_(width), height_(height) {
    const bool is_transposed = orientation >= 5 && orientation <= 8;
    // The place of the stored pixel (x, y) is (x, y) or, transposed, (y, x), counted from the left
    // or the right and from the top or the bottom.
    const bool from_right =
        orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
    const bool from_below =
        orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
    if (is_transposed) {
      width_ = height;
      height_ = width;
    }
    const auto right = static_cast<std::ptrdiff_t>(from_right ? -1 : 1);
    const std::ptrdiff_t down = from_below ? -width_ : width_;
    per_x_ = is_transposed ? down : right;
    per_y_ = is_transposed ? right : down;
    first_ = (from_right ? width_ - 1 : 0) +
             (from_below ? static_cast<std::ptrdiff_t>(height_ - 1) * width_ : 0);
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool is_identity() const { return first_ == 0 && per_x_ == 1; }
  /// Returns the index, row by row, of the stored pixel (x, y) in the turned image.
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(first_ + per_x_ * x + per_y_ * y);
  }

 private:
  int width_, height_;
  std::ptrdiff_t first_ = 0, per_x_ = 1, per_y_ = 0;
};

}  // namespace hydroprint::image
