#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/image/io/printer_image.h"

namespace hydroprint::print {

/// A line drawn with a round pen. Coordinates are in the page's frame: mm from the sheet's lower
/// left corner, x to the right, y up.
struct Stroke {
  std::vector<Eigen::Vector2d> points_mm;
  double width_mm = 0.25;
  double ink = 1;  ///< amount of black, from 0 to 1
};

/// A line of text in the document's font, UTF-8. Coordinates are in the page's frame, as for
/// Stroke.
struct Text {
  std::string text;
  Eigen::Vector2d at_mm = Eigen::Vector2d::Zero();  ///< start of the baseline
  double x_height_mm = 1.6;                         ///< height of a lower-case x
  double ink = 1;                                   ///< amount of black, from 0 to 1
};

/// Lines and text that are placed together.
struct Drawing {
  std::vector<Stroke> strokes;
  std::vector<Text> texts;
};

/// An image on a page. Pixels are square, exactly pitch_mm wide.
struct PlacedImage {
  image::PrinterImage image;
  double pitch_mm = 1;
  Eigen::Vector2d low_mm = Eigen::Vector2d::Zero();  ///< position of its lower left corner
};

/// One side of one sheet of paper.
struct Page {
  Eigen::Vector2d size_mm = Eigen::Vector2d::Zero();
  std::vector<PlacedImage> images;
  std::vector<Stroke> strokes;  ///< drawn over the images
  std::vector<Text> texts;      ///< drawn over the strokes
};

/// Pages that are printed together, and the colour space of their images.
struct Document {
  std::string title;
  /// Profile of the printer for which the images are made; empty: sRGB or plain CMYK.
  std::string icc_profile;
  bool cmyk = false;  ///< images have four channels, strokes use black ink only
  std::vector<Page> pages;
};

}  // namespace hydroprint::print
