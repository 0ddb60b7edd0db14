#include "renderer/sky/sky_color.h"

#include "renderer/math/transcendental.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace renderer {

namespace {

// Lobe of other widths below and above its middle.
double lobe(double nm, double middle, double below, double above)
{
    const double t = (nm - middle) * (nm < middle ? below : above);
    return exp(-0.5 * t * t);
}

std::array<double, 3> rec709_of(double nm)
{
    const double x = 0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
                     0.065 * lobe(nm, 501.1, 0.0490, 0.0382);
    const double y = 0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322);
    const double z = 1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725);
    return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
            -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

// Of a black body of 5778 K, in any unit.
double sunlight(double nm)
{
    const double um = nm * 1e-3, um5 = um * um * um * um * um;
    return 1 / (um5 * (exp(14387.77 / (um * 5778)) - 1));
}

// How much of the spectrum each wavelength stands for, in nm: half of the way to its neighbours, and as far beyond the last.
std::vector<double> widths_of(const std::vector<double>& wavelengths_nm)
{
    const std::size_t n = wavelengths_nm.size();
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return wavelengths_nm[a] < wavelengths_nm[b];
    });
    std::vector<double> widths(n, n == 1 ? 1.0 : 0.0);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        const double half = (wavelengths_nm[order[i + 1]] - wavelengths_nm[order[i]]) / 2;
        widths[order[i]] += i == 0 ? 2 * half : half;
        widths[order[i + 1]] += i + 2 == n ? 2 * half : half;
    }
    return widths;
}

// One a wavelength; each channel sums to 1.
std::vector<std::array<double, 3>> weights_of(const std::vector<double>& wavelengths_nm)
{
    std::vector<std::array<double, 3>> weights(wavelengths_nm.size());
    const std::size_t n = wavelengths_nm.size();
    if (n == 3) {
        std::array<std::size_t, 3> order{0, 1, 2};
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return wavelengths_nm[a] > wavelengths_nm[b];
        });
        for (std::size_t c = 0; c < 3; ++c)
            weights[order[c]][c] = 1;
        return weights;
    }
    std::array<double, 3> sum{};
    const std::vector<double> widths = widths_of(wavelengths_nm);
    for (std::size_t w = 0; w < n; ++w) {
        weights[w] = rec709_of(wavelengths_nm[w]);
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += weights[w][c] *= sunlight(wavelengths_nm[w]) * widths[w];
    }
    for (auto& weight : weights)
        for (std::size_t c = 0; c < 3; ++c)
            weight[c] = sum[c] > 0 ? weight[c] / sum[c] : 1 / static_cast<double>(n);
    return weights;
}

} // namespace

SkyColor::SkyColor(const std::vector<double>& wavelengths_nm, Rgb irradiance)
    : weight_(weights_of(wavelengths_nm)), lanes_(lane_groups(weight_.size())), irradiance_(irradiance)
{
    for (std::size_t w = 0; w < weight_.size(); ++w) {
        const Rgb channels{static_cast<float>(weight_[w][0]),
                           static_cast<float>(weight_[w][1]),
                           static_cast<float>(weight_[w][2])};
        const Rgb all = channels * irradiance;
        auto& lanes = lanes_[w / kLanes];
        lanes[0][w % kLanes] = all.r;
        lanes[1][w % kLanes] = all.g;
        lanes[2][w % kLanes] = all.b;
        columns_.push_back(Lanes{all.r, all.g, all.b, 0});
    }
}

Rgb SkyColor::of_lanes(const Lanes* groups) const
{
    Lanes sum[3]{};
    for (std::size_t g = 0; g < lanes_.size(); ++g)
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += groups[g] * lanes_[g][c];
    const auto total = [](Lanes x) { return std::max(0.0f, (x[0] + x[1]) + (x[2] + x[3])); };
    return {total(sum[0]), total(sum[1]), total(sum[2])};
}

Rgb SkyColor::share(const Spectrum& spectrum) const
{
    std::array<double, 3> sum{};
    for (std::size_t w = 0; w < weight_.size(); ++w)
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += weight_[w][c] * spectrum[w];
    // Colours outside Rec. 709 lose what is below 0.
    return {static_cast<float>(std::max(0.0, sum[0])),
            static_cast<float>(std::max(0.0, sum[1])),
            static_cast<float>(std::max(0.0, sum[2]))};
}

Rgb SkyColor::share_of_lanes(const Lanes* groups) const
{
    Rgb sum{};
    for (std::size_t w = 0; w < weight_.size(); ++w) {
        const float left = groups[w / kLanes][w % kLanes];
        sum += Rgb{static_cast<float>(weight_[w][0]),
                   static_cast<float>(weight_[w][1]),
                   static_cast<float>(weight_[w][2])} *
               left;
    }
    return {std::max(0.0f, sum.r), std::max(0.0f, sum.g), std::max(0.0f, sum.b)};
}

Rgb SkyColor::operator()(const Spectrum& spectrum) const
{
    return share(spectrum) * irradiance_;
}

} // namespace renderer
