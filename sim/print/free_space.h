#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace hydroprint::print {

/// An upright rectangle on a page, mm.
struct Box {
  Eigen::Vector2d low_mm = Eigen::Vector2d::Zero(), high_mm = Eigen::Vector2d::Zero();

  [[nodiscard]] Eigen::Vector2d size_mm() const { return high_mm - low_mm; }
};

/// Keeps track of the free part of a sheet, for placing marks, in cells of half a millimetre. A
/// cell counts as taken if any part of it is taken.
class FreeSpace {
 public:
  /// @param printable  part of the sheet, initially free
  explicit FreeSpace(const Box& printable);

  /// Marks the inside of a simple polygon, and everything within `clearance_mm` of its edge, as
  /// taken.
  void take(const std::vector<Eigen::Vector2d>& polygon, double clearance_mm);
  void take(const Box& box);

  [[nodiscard]] bool is_free(const Box& box) const;

  /// Returns the free rectangle of this size whose middle is nearest to a point; nullopt if there
  /// is none.
  [[nodiscard]] std::optional<Box> find(const Eigen::Vector2d& size_mm,
                                        const Eigen::Vector2d& near_mm) const;

 private:
  /// Cells [x0, x1) by [y0, y1).
  struct Cells {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  };
  [[nodiscard]] Cells cells_under(const Box& box) const;
  void take(const Cells& cells);
  [[nodiscard]] std::vector<int> taken_sums() const;

  Box printable_;
  int columns_ = 0, rows_ = 0;
  std::vector<char> taken_;
};

}  // namespace hydroprint::print
