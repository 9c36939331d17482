#pragma once

#include <optional>
#include <string>
#include <vector>

namespace driftless {

/// A line through points, or points alone. Colours are the page's classes c0, c1, ...
struct ChartLine {
  std::string name;
  std::size_t colour = 0;
  std::vector<double> x, y;
  bool dashed = false;
  bool points_alone = false;
};

/// A level across the whole chart, named at its right end.
struct ChartLevel {
  std::string name;
  std::size_t colour = 0;
  double y = 0;
  bool dotted = false;  ///< dashed otherwise
};

/// Two logarithmic axes; every x is above 0, every y too.
struct LogChart {
  std::string title, x_title, y_title;
  std::vector<ChartLine> lines = {};
  std::vector<ChartLevel> levels = {};
  bool y_from_zero = false;  ///< linear y from 0
  bool x_ticks_at_points = false;
};
/// The chart as an <svg> element, with a legend of its lines below it.
std::string svg(const LogChart& chart);

/// Bars side by side from left to right, a row each, of parts one after the other.
struct BarChart {
  std::string title, x_title;
  std::vector<std::string> parts;  ///< names; the n-th has the class cn
  struct Bar {
    std::string name, remark;
    std::vector<double> parts;
  };
  std::vector<Bar> bars;
};
std::string svg(const BarChart& chart);

/// Text for HTML and SVG.
std::string escaped(const std::string& text);
/// "850", "1.2k", "3M".
std::string short_number(double value);

}  // namespace driftless
