#include "experiments/bench/svg_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftless {
namespace {

/// Where data lie in the picture.
struct Scale {
  double from, to;    ///< of the data
  double begin, end;  ///< in the picture
  bool logarithmic = true;

  double operator()(double value) const {
    const double share =
        logarithmic ? std::log(value / from) / std::log(to / from) : (value - from) / (to - from);
    return begin + share * (end - begin);
  }
};

/// 1, 2 and 5 times powers of ten.
std::vector<double> log_ticks(const Scale& scale) {
  std::vector<double> ticks;
  const bool wide = scale.to / scale.from > 300;
  for (double power = std::pow(10, std::floor(std::log10(scale.from))); power <= scale.to;
       power *= 10) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      if (wide && digit > 1) continue;
      const double tick = digit * power;
      if (tick >= scale.from * 0.999 && tick <= scale.to * 1.001) ticks.push_back(tick);
    }
  }
  return ticks;
}

std::vector<double> even_ticks(double to) {
  const double power = std::pow(10, std::floor(std::log10(to / 4)));
  double step = power;
  for (const double digit : {2.0, 5.0, 10.0}) {
    if (to / step > 6) step = digit * power;
  }
  std::vector<double> ticks;
  for (int n = 0; n * step <= to * 1.001; ++n) ticks.push_back(n * step);
  return ticks;
}

std::string line(const char* style, double x1, double y1, double x2, double y2) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>",
                     style, x1, y1, x2, y2);
}

std::string label(const std::string& style, double x, double y, const std::string& text) {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", style, x, y,
                     escaped(text));
}

constexpr double width = 560, height = 380;
constexpr double left = 56, right = 150, top = 14, bottom = 46;
constexpr double row_height = 16;  // of a legend's entry

struct Axes {
  Scale x, y;
};

Axes axes_of(const LogChart& chart) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double x_least = infinity, x_most = 0, y_least = infinity, y_most = 0;
  for (const auto& one : chart.lines) {
    for (const double x : one.x) x_least = std::min(x_least, x), x_most = std::max(x_most, x);
    for (const double y : one.y) y_least = std::min(y_least, y), y_most = std::max(y_most, y);
  }
  for (const auto& level : chart.levels) {
    y_least = std::min(y_least, level.y), y_most = std::max(y_most, level.y);
  }
  const Scale x{x_least / 1.15, x_most * 1.15, left, width - right};
  if (chart.y_from_zero) return {x, {0, y_most * 1.05, height - bottom, top, false}};
  return {x, {y_least / 1.2, y_most * 1.2, height - bottom, top}};
}

std::string grid(const LogChart& chart, const Axes& axes) {
  std::string text;
  auto x_ticks = log_ticks(axes.x);
  if (chart.x_ticks_at_points) x_ticks = chart.lines.front().x;
  for (const double tick : x_ticks) {
    text += line("grid", axes.x(tick), top, axes.x(tick), height - bottom);
    text += label("tick middle", axes.x(tick), height - bottom + 16, short_number(tick));
  }
  for (const double tick : chart.y_from_zero ? even_ticks(axes.y.to) : log_ticks(axes.y)) {
    text += line("grid", left, axes.y(tick), width - right, axes.y(tick));
    text += label("tick end", left - 6, axes.y(tick) + 4, short_number(tick));
  }
  text += label("axis middle", (left + width - right) / 2, height - 8, chart.x_title);
  text += fmt::format(
      "<text class=\"axis middle\" transform=\"translate(13 {:.1f}) rotate(-90)\">{}</text>",
      (top + height - bottom) / 2, escaped(chart.y_title));
  return text;
}

/// Levels, their names moved apart where they would lie on each other.
std::string levels(const LogChart& chart, const Axes& axes) {
  auto sorted = chart.levels;
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.y > b.y; });
  std::string text;
  double lowest = top;
  std::vector<double> places;
  for (const auto& level : sorted) {
    places.push_back(std::max(axes.y(level.y), lowest));
    lowest = places.back() + 13;
  }
  double highest = height - bottom;
  for (std::size_t n = places.size(); n-- > 0;) {
    places[n] = std::min(places[n], highest);
    highest = places[n] - 13;
  }
  for (std::size_t n = 0; n < sorted.size(); ++n) {
    const auto& level = sorted[n];
    const double y = axes.y(level.y), edge = width - right;
    text +=
        line(fmt::format("line c{} {}", level.colour, level.dotted ? "dotted" : "dashed").c_str(),
             left, y, edge, y);
    text += line("leader", edge, y, edge + 10, places[n]);
    text += label(fmt::format("level c{}", level.colour), edge + 13, places[n] + 4, level.name);
  }
  return text;
}

std::string mark(const ChartLine& of, double x, double y, const std::string& tip) {
  const char* const shape = of.points_alone ? "hollow" : of.dashed ? "open" : "solid";
  return fmt::format(
      "<circle class=\"{} c{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"><title>{}</title></circle>",
      shape, of.colour, x, y, escaped(tip));
}

std::string data(const ChartLine& of, const Axes& axes) {
  std::string points, marks;
  for (std::size_t n = 0; n < of.x.size(); ++n) {
    const double x = axes.x(of.x[n]), y = axes.y(of.y[n]);
    points += fmt::format("{:.1f},{:.1f} ", x, y);
    marks += mark(of, x, y, fmt::format("{}: {:.4g} at {:.0f}", of.name, of.y[n], of.x[n]));
  }
  if (of.points_alone) return marks;
  return fmt::format("<polyline class=\"line c{}{}\" points=\"{}\"/>{}", of.colour,
                     of.dashed ? " broken" : "", points, marks);
}

std::string opening(const std::string& title, double high) {
  return fmt::format(
      "<svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\" "
      "xmlns=\"http://www.w3.org/2000/svg\">",
      width, high, escaped(title));
}

}  // namespace

std::string svg(const LogChart& chart) {
  const Axes axes = axes_of(chart);
  const auto rows = static_cast<double>((chart.lines.size() + 1) / 2);
  std::string text = opening(chart.title, height + row_height * rows + 4);
  text += grid(chart, axes) + levels(chart, axes);
  for (const auto& one : chart.lines) text += data(one, axes);
  for (std::size_t n = 0; n < chart.lines.size(); ++n) {
    const auto& one = chart.lines[n];
    const double x = left + 240 * static_cast<double>(n % 2);
    const double y = height + 8 + row_height * static_cast<double>(n / 2);
    if (!one.points_alone) {
      text += line(fmt::format("line c{}{}", one.colour, one.dashed ? " broken" : "").c_str(), x, y,
                   x + 24, y);
    }
    text += mark(one, x + 12, y, one.name) + label("legend", x + 32, y + 4, one.name);
  }
  return text + "</svg>";
}

std::string svg(const BarChart& chart) {
  constexpr double bar_left = 200, bar_right = 70, pitch = 22, thick = 15, head = 26;
  double most = 0;
  for (const auto& bar : chart.bars) {
    double sum = 0;
    for (const double part : bar.parts) sum += part;
    most = std::max(most, sum);
  }
  const Scale scale{0, most, bar_left, width - bar_right, false};
  const double end = head + pitch * static_cast<double>(chart.bars.size());
  std::string text = opening(chart.title, end + 42);
  for (std::size_t part = 0; part < chart.parts.size(); ++part) {
    const double x = 8 + 108 * static_cast<double>(part);
    text += fmt::format(
        "<rect class=\"fill s{}\" x=\"{:.1f}\" y=\"4\" width=\"12\" height=\"12\"/>", part, x);
    text += label("legend", x + 17, 14, chart.parts[part]);
  }
  for (const double tick : even_ticks(most)) {
    text += line("grid", scale(tick), head, scale(tick), end);
    text += label("tick middle", scale(tick), end + 15, fmt::format("{:g}", tick));
  }
  for (std::size_t n = 0; n < chart.bars.size(); ++n) {
    const auto& bar = chart.bars[n];
    const double y = head + pitch * static_cast<double>(n) + (pitch - thick) / 2;
    text += label("tick end", bar_left - 6, y + 12, bar.name);
    double sum = 0;
    for (std::size_t part = 0; part < bar.parts.size(); ++part) {
      const double x = scale(sum);
      sum += bar.parts[part];
      text += fmt::format(
          "<rect class=\"fill s{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.0f}\">"
          "<title>{}, {}: {:.1f}</title></rect>",
          part, x, y, std::max(0.0, scale(sum) - x), thick, escaped(bar.name),
          escaped(chart.parts[part]), bar.parts[part]);
    }
    text += label("tick", scale(sum) + 5, y + 12, bar.remark);
  }
  text += label("axis middle", (bar_left + width - bar_right) / 2, end + 34, chart.x_title);
  return text + "</svg>";
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char character : text) {
    switch (character) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += character;
    }
  }
  return safe;
}

std::string short_number(double value) {
  if (value >= 1e6) return fmt::format("{:g}M", value / 1e6);
  if (value >= 10'000) return fmt::format("{:g}k", value / 1e3);
  return fmt::format("{:g}", value);
}

}  // namespace driftless
