#include "tenon/apps/profile_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace tenon {

namespace {

// Lengths in pixels.
constexpr double kPanelWidth = 440, kPanelHeight = 320;
constexpr double kLeft = 62, kTop = 70, kGap = 70, kBottom = 60;
constexpr double kLegendWidth = 170;
constexpr double kWidestRatio = 1 << 14;  // further out nothing is drawn: the curves have long ended

/// Told apart by colour, and by dash where colour is no help (Okabe and Ito's palette).
struct Pen {
  std::string_view color, dash;
};
constexpr Pen kPens[] = {{"#0072b2", ""},    {"#d55e00", "8 3"}, {"#009e73", "2 3"}, {"#cc79a7", "10 3 2 3"},
                         {"#e69f00", "5 5"}, {"#56b4e9", "3 2"}, {"#000000", "12 4"}};

const Pen& pen(std::size_t s) {
  return kPens[s % std::size(kPens)];
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

std::string text(double x, double y, std::string_view anchor, double size, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\">{}</text>\n", x, y, anchor, size, escaped(words));
}

std::string line(double x1, double y1, double x2, double y2, std::string_view style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1, x2, y2, style);
}

std::string stroke(const Pen& p) {
  return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}", p.color,
                     p.dash.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", p.dash));
}

/// One panel: ratios to the right by powers of two, shares upwards.
class Panel {
 public:
  Panel(const ProfilePanel& panel, double left) : panel_(panel), left_(left) {
    const double widest = std::min(panel.profile.ratios.back(), kWidestRatio);
    powers_ = std::max(1.0, std::ceil(std::log2(widest) * 1.02));
  }

  std::string draw() const {
    std::string svg = frame();
    for (std::size_t s = 0; s < panel_.profile.solvers.size(); ++s) svg += curve(s);
    return svg;
  }

 private:
  double x(double ratio) const { return left_ + kPanelWidth * std::min(std::log2(ratio) / powers_, 1.0); }
  static double y(double share) { return kTop + kPanelHeight * (1 - share); }

  std::string frame() const {
    constexpr std::string_view kGrid = "stroke=\"#dddddd\"", kAxis = "stroke=\"#444444\"";
    std::string svg = text(left_ + kPanelWidth / 2, kTop - 12, "middle", 14, panel_.title);
    for (int percent = 0; percent <= 100; percent += 20) {
      svg += line(left_, y(percent / 100.0), left_ + kPanelWidth, y(percent / 100.0), kGrid);
      svg += text(left_ - 8, y(percent / 100.0) + 4, "end", 12, fmt::format("{} %", percent));
    }
    const int every = static_cast<int>(std::ceil(powers_ / 8));
    for (int power = 0; power <= static_cast<int>(powers_); power += every) {
      const double at = x(std::exp2(power));
      svg += line(at, y(0), at, y(1), kGrid);
      svg += text(at, y(0) + 18, "middle", 12, fmt::format("{}", 1L << power));
    }
    svg += line(left_, y(0), left_ + kPanelWidth, y(0), kAxis) + line(left_, y(0), left_, y(1), kAxis);
    return svg + text(left_ + kPanelWidth / 2, y(0) + 40, "middle", 12, "at most so many times the best");
  }

  std::string curve(std::size_t s) const {
    const PerformanceProfile& profile = panel_.profile;
    std::string points = fmt::format("{:.1f},{:.1f}", x(1), y(profile.shares[s].front()));
    for (std::size_t k = 1; k < profile.ratios.size(); ++k) {
      if (profile.shares[s][k] == profile.shares[s][k - 1]) continue;
      points += fmt::format(" {0:.1f},{1:.1f} {0:.1f},{2:.1f}", x(profile.ratios[k]), y(profile.shares[s][k - 1]), y(profile.shares[s][k]));
    }
    points += fmt::format(" {:.1f},{:.1f}", left_ + kPanelWidth, y(profile.shares[s].back()));
    return fmt::format("<polyline points=\"{}\" {}/>\n", points, stroke(pen(s)));
  }

  const ProfilePanel& panel_;
  double left_;
  double powers_;  // of two, shown to the right
};

}  // namespace

std::string profile_picture(const std::string& title, const std::vector<ProfilePanel>& panels) {
  const auto left_of = [](std::size_t k) { return kLeft + static_cast<double>(k) * (kPanelWidth + kGap); };
  const double legend = left_of(panels.size()) - kGap + 24;
  const double width = legend + kLegendWidth, height = kTop + kPanelHeight + kBottom;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "font-family=\"sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      width, height);
  svg += text(kLeft, 28, "start", 16, title);
  for (std::size_t k = 0; k < panels.size(); ++k) svg += Panel(panels[k], left_of(k)).draw();
  const std::vector<std::string>& solvers = panels.front().profile.solvers;
  for (std::size_t s = 0; s < solvers.size(); ++s) {
    const double at = kTop + 14 + 24 * static_cast<double>(s);
    svg += line(legend, at - 4, legend + 36, at - 4, stroke(pen(s)));
    svg += text(legend + 44, at, "start", 13, solvers[s]);
  }
  return svg + "</svg>\n";
}

}  // namespace tenon
