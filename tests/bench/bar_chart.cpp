#include "tests/bench/bar_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bench {

namespace {

constexpr double kWidth = 920, kLabels = 330, kRight = 150, kTop = 78, kRow = 26, kHeading = 30, kBottom = 56;
constexpr const char* kColours[] = {
    "#9e3d22", "#d45b21", "#f6a45c", "#7fb3c8", "#3f83a8", "#1f5a80", "#123a57"};

std::string escaped(const std::string& text)
{
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else
            out += c;
    }
    return out;
}

template <typename... Values>
std::string format(const char* pattern, Values... values)
{
    char text[400];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

// Three digits that matter, no exponent.
std::string number(double value)
{
    if (value == 0) return "0";
    const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(std::abs(value)))), 0, 9);
    std::string text = format("%.*f", decimals, value);
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') text.pop_back();
    }
    return text;
}

class Axis {
public:
    explicit Axis(const BarChart& chart) : logarithmic_(chart.logarithmic)
    {
        double least = INFINITY, greatest = 0;
        for (const BarGroup& group : chart.groups)
            for (const Bar& bar : group.bars) {
                least = std::min(least, bar.value.least);
                greatest = std::max(greatest, bar.value.greatest);
            }
        if (!(greatest > 0)) greatest = 1;
        if (logarithmic_) {
            low_ = std::floor(std::log10(std::clamp(least * 0.8, greatest * 1e-9, greatest)));
            high_ = std::ceil(std::log10(greatest) - 1e-9);
            if (high_ <= low_) high_ = low_ + 1;
        } else {
            step_ = nice_step(greatest);
            high_ = step_ * std::ceil(greatest / step_ - 1e-9);
        }
    }

    double x(double value) const
    {
        const double at = logarithmic_ ? std::log10(std::max(value, std::pow(10, low_))) : value;
        return kLabels + (kWidth - kLabels - kRight) * std::clamp((at - low_) / (high_ - low_), 0.0, 1.0);
    }
    std::vector<double> ticks() const
    {
        std::vector<double> out;
        if (logarithmic_)
            for (double exponent = low_; exponent <= high_ + 0.5; ++exponent)
                out.push_back(std::pow(10, exponent));
        else
            for (double i = 0; i * step_ <= high_ * 1.001; ++i)
                out.push_back(i * step_);
        return out;
    }

private:
    // 1, 2 or 5 times a power of ten, so that there are four to eight.
    static double nice_step(double greatest)
    {
        const double raw = greatest / 5, power = std::pow(10, std::floor(std::log10(raw)));
        for (const double factor : {1.0, 2.0, 5.0})
            if (raw <= factor * power) return factor * power;
        return 10 * power;
    }

    bool logarithmic_;
    double low_ = 0, high_ = 1, step_ = 1;
};

std::string text_at(double x, double y, const char* style, const std::string& text)
{
    return format("<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, style) + escaped(text) + "</text>\n";
}

std::string line(double x0, double y0, double x1, double y1, const char* style)
{
    return format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", x0, y0, x1, y1, style);
}

std::string bar_at(const Bar& bar, double y, const char* colour, const Axis& axis)
{
    const double left = axis.x(0), right = axis.x(bar.value.median), middle = y + kRow / 2 - 2;
    std::string out = text_at(kLabels - 10, middle + 5, "text-anchor=\"end\" font-size=\"14\"", bar.label);
    out += format("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"/>\n",
                  left,
                  y,
                  std::max(1.0, right - left),
                  kRow - 6,
                  colour);
    const double low = axis.x(bar.value.least), high = axis.x(bar.value.greatest);
    if (high - low > 2) {
        const char* const whisker = "stroke=\"#222\" stroke-width=\"1.2\"";
        out += line(low, middle - 1, high, middle - 1, whisker) +
               line(low, y + 5, low, y + kRow - 11, whisker) +
               line(high, y + 5, high, y + kRow - 11, whisker);
    }
    const std::string note = bar.note.empty() ? "" : "  (" + bar.note + ")";
    return out +
           text_at(
               std::max(right, high) + 8, middle + 5, "font-size=\"13\"", number(bar.value.median) + note);
}

} // namespace

std::string to_svg(const BarChart& chart)
{
    const Axis axis(chart);
    double height = kTop + kBottom;
    for (const BarGroup& group : chart.groups)
        height += (group.name.empty() ? 0 : kHeading) + kRow * static_cast<double>(group.bars.size());
    const double foot = height - kBottom;
    std::string svg = format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
                             "viewBox=\"0 0 %.0f %.0f\" font-family=\"DejaVu Sans, Arial, sans-serif\" "
                             "fill=\"#222\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
                             kWidth,
                             height,
                             kWidth,
                             height);
    svg += text_at(20, 30, "font-size=\"19\" font-weight=\"bold\"", chart.title);
    svg += text_at(20, 52, "font-size=\"13\" fill=\"#555\"", chart.subtitle);
    for (const double tick : axis.ticks()) {
        svg += line(axis.x(tick), kTop - 8, axis.x(tick), foot, "stroke=\"#ddd\"");
        svg += text_at(axis.x(tick), foot + 18, "text-anchor=\"middle\" font-size=\"12\"", number(tick));
    }
    svg += line(kLabels, foot, kWidth - kRight, foot, "stroke=\"#222\"");
    svg += text_at((kLabels + kWidth - kRight) / 2,
                   foot + 40,
                   "text-anchor=\"middle\" font-size=\"13\"",
                   chart.axis + (chart.logarithmic ? " (logarithmic)" : ""));
    double y = kTop;
    for (const BarGroup& group : chart.groups) {
        if (!group.name.empty()) {
            svg += text_at(20, y + 18, "font-size=\"14\" font-weight=\"bold\"", group.name);
            y += kHeading;
        }
        std::size_t colour = 0;
        for (const Bar& bar : group.bars) {
            svg += bar_at(bar, y, kColours[colour++ % std::size(kColours)], axis);
            y += kRow;
        }
    }
    return svg + "</svg>\n";
}

} // namespace bench
