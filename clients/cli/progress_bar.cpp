#include "clients/cli/progress_bar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace clients {
namespace {

std::string duration(double seconds)
{
    const long whole = std::lround(seconds);
    if (whole < 120) return std::to_string(whole) + " s";
    if (whole < 7200) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
    return std::to_string(whole / 3600) + " h " + std::to_string(whole / 60 % 60) + " min";
}

} // namespace

std::string progress_line(double fraction, double elapsed_s, const std::string& note)
{
    constexpr int kCells = 30;
    fraction = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
    const auto full = static_cast<std::size_t>(std::lround(fraction * kCells));
    const std::string percent = std::to_string(static_cast<int>(fraction * 100));
    std::string line = '[' + std::string(full, '#') + std::string(kCells - full, '.') + "] ";
    line += std::string(3 - percent.size(), ' ') + percent + '%';
    // An estimate before 2 % or a second is a guess.
    if (fraction >= 0.02 && fraction < 1 && elapsed_s >= 1)
        line += "  " + duration(elapsed_s * (1 - fraction) / fraction) + " left";
    if (!note.empty()) line += "  " + note;
    return line;
}

ProgressBar::ProgressBar(bool wanted)
    : visible_(wanted && ::isatty(STDERR_FILENO) == 1), start_(std::chrono::steady_clock::now())
{
}

ProgressBar::~ProgressBar()
{
    if (visible_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::show(double fraction, const std::string& note)
{
    if (!visible_) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    std::fprintf(stderr, "\r\033[K%s", progress_line(fraction, elapsed.count(), note).c_str());
    std::fflush(stderr);
}

} // namespace clients
