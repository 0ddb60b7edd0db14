#include "renderer/sky/single_scattering.h"

#include "renderer/math/transcendental.h"
#include "renderer/sky/gauss_legendre.h"
#include "renderer/sky/optical_depth.h"
#include "renderer/sky/phase.h"
#include "renderer/sky/shadow_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace renderer {

namespace {

constexpr std::size_t kPoints = 16;
constexpr int kMostHalvings = 12;
constexpr double kTolerance = 1e-8;      // of the whole, of the difference between a piece and its halves
constexpr double kQuickTolerance = 1e-3; // of the whole, of what a piece is thought to be off by

// Legendre polynomials of orders n - 2 and n - 1, normed so that their mean with a smooth function is its part of them.
std::array<double, 2> highest_polynomials(std::size_t n, double z)
{
    double value = 1, previous = 0;
    for (std::size_t k = 1; k < n; ++k) {
        const double order = static_cast<double>(k);
        const double next = ((2 * order - 1) * z * value - (order - 1) * previous) / order;
        previous = value;
        value = next;
    }
    const double most = 2 * static_cast<double>(n) - 1;
    return {(most - 2) * previous, most * value};
}

// Where light comes in along a ray, and what of it reaches the eye.
class InScattering {
public:
    InScattering(const Air& air, const PlanetRay& ray, const SkyGeometry& geometry, std::size_t points)
        : air_(air), ray_(ray), geometry_(geometry), rule_(points),
          phase_rayleigh_(rayleigh_phase(geometry.nu)), phase_mie_(mie_phase(air.phase, air.g, geometry.nu))
    {
        for (const double x : rule_.x)
            highest_.push_back(highest_polynomials(points, 2 * x - 1));
    }

    struct Piece {
        double begin = 0, end = 0;
        Columns to_begin; // from the eye
        Spectrum value{};
        std::array<Spectrum, 2>
            highest{}; // its parts that are Legendre polynomials of the highest orders seen
    };

    // value, by one application of the rule.
    void estimate(Piece& piece) const
    {
        piece.value.fill(0);
        piece.highest = {};
        const double length = piece.end - piece.begin;
        for (std::size_t i = 0; i < rule_.x.size(); ++i) {
            const double u = piece.begin + length * rule_.x[i];
            const double altitude = std::max(0.0, ray_.altitude(u)), weight = length * rule_.weight[i];
            const Columns way = piece.to_begin + columns_along(air_, ray_, piece.begin, u) +
                                columns_past_ground(air_, altitude, sun_cosine(u));
            const Columns density = air_.density(altitude);
            const double rayleigh = weight * density.rayleigh * phase_rayleigh_;
            const double mie = weight * density.mie * phase_mie_;
            for (std::size_t w = 0; w < air_.wavelengths; ++w) {
                const double more =
                    (air_.rayleigh[w] * rayleigh + air_.mie_scattering[w] * mie) * air_.transmittance(w, way);
                piece.value[w] += more;
                piece.highest[0][w] += highest_[i][0] * more;
                piece.highest[1][w] += highest_[i][1] * more;
            }
        }
    }

    // Both halves, estimated.
    [[nodiscard]] std::pair<Piece, Piece> halve(const Piece& whole) const
    {
        const double middle = whole.begin + (whole.end - whole.begin) / 2;
        std::pair<Piece, Piece> halves{{whole.begin, middle, whole.to_begin, {}},
                                       {middle, whole.end, whole.to_begin, {}}};
        halves.second.to_begin = whole.to_begin + columns_along(air_, ray_, whole.begin, middle);
        estimate(halves.first);
        estimate(halves.second);
        return halves;
    }

    [[nodiscard]] double sun_cosine(double u) const
    {
        const double start_radius = ray_.radius_at(ray_.start());
        const double cosine =
            (start_radius * geometry_.mu_sun + (u - ray_.start()) * geometry_.nu) / ray_.radius_at(u);
        return std::clamp(cosine, -1.0, 1.0);
    }

private:
    const Air& air_;
    const PlanetRay& ray_;
    const SkyGeometry& geometry_;
    GaussLegendre rule_;
    double phase_rayleigh_, phase_mie_;
    std::vector<std::array<double, 2>> highest_; // at each point
};

// The places, ascending, between which everything along the ray is smooth.
std::vector<double> stops_along(const Air& air, const PlanetRay& ray, const SkyGeometry& geometry)
{
    const PlanetRay::Reach reach = ray.reach(air.height_m);
    std::vector<double> stops{reach.begin, reach.end, 0};
    for (const double cut : air.cuts) {
        if (cut <= ray.perigee()) continue;
        stops.push_back(ray.distance_at(cut));
        stops.push_back(-stops.back());
    }
    for (const double s : shadow_edges(air.radius_m, geometry))
        stops.push_back(ray.start() + s);
    std::erase_if(stops, [&](double u) { return !(u >= reach.begin && u <= reach.end); });
    std::sort(stops.begin(), stops.end());
    return stops;
}

// A sun whose ray grazes the ground within rounding is seen: lines of sight along the edge of the shadow are lit.
bool sees_sun(double radius, double altitude, double cosine)
{
    return cosine >= 0 || PlanetRay(radius, std::max(0.0, altitude), cosine).perigee() > -1e-12 * radius;
}

void add(Spectrum& sum, const Spectrum& more, std::size_t wavelengths)
{
    for (std::size_t w = 0; w < wavelengths; ++w)
        sum[w] += more[w];
}

bool agree(const Spectrum& whole,
           const Spectrum& first,
           const Spectrum& second,
           const Spectrum& scale,
           std::size_t n)
{
    for (std::size_t w = 0; w < n; ++w)
        if (!(std::abs(first[w] + second[w] - whole[w]) <= kTolerance * scale[w])) return false;
    return true;
}

Spectrum settle(const InScattering& light,
                const InScattering::Piece& whole,
                const Spectrum& scale,
                std::size_t n,
                int depth)
{
    const auto [first, second] = light.halve(whole);
    Spectrum sum = first.value;
    add(sum, second.value, n);
    if (depth == kMostHalvings || agree(whole.value, first.value, second.value, scale, n)) return sum;
    sum = settle(light, first, scale, n, depth + 1);
    add(sum, settle(light, second, scale, n, depth + 1), n);
    return sum;
}

// Parts fall by about the same factor from one order to the next, and the rule is exact to twice the orders that it sees:
// what it is off by is to the highest part as that is to the whole.
bool is_smooth(const InScattering::Piece& piece, const Spectrum& scale, std::size_t n)
{
    for (std::size_t w = 0; w < n; ++w) {
        const double part = std::abs(piece.highest[0][w]) + std::abs(piece.highest[1][w]);
        if (part * part > kQuickTolerance * scale[w] * piece.value[w]) return false;
    }
    return true;
}

// Halves a piece only where its own points say that they are too few.
Spectrum settle_quickly(const InScattering& light,
                        const InScattering::Piece& piece,
                        const Spectrum& scale,
                        std::size_t n,
                        int depth)
{
    if (depth == kMostHalvings || is_smooth(piece, scale, n)) return piece.value;
    const auto [first, second] = light.halve(piece);
    Spectrum sum = settle_quickly(light, first, scale, n, depth + 1);
    add(sum, settle_quickly(light, second, scale, n, depth + 1), n);
    return sum;
}

} // namespace

SingleScattering single_scattering(const Air& air, const SkyGeometry& geometry, SkyPrecision precision)
{
    return single_scattering(
        air, PlanetRay(air.radius_m, geometry.altitude_m, geometry.mu), geometry, precision);
}

SingleScattering
single_scattering(const Air& air, const PlanetRay& ray, const SkyGeometry& geometry, SkyPrecision precision)
{
    SingleScattering result;
    const bool exact = precision == SkyPrecision::exact;
    const InScattering light(air, ray, geometry, exact ? kPoints : kPoints / 2);
    const std::vector<double> stops = stops_along(air, ray, geometry);
    std::vector<InScattering::Piece> pieces;
    Columns way;
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
        if (!(stops[i + 1] > stops[i])) continue;
        const double middle = stops[i] + (stops[i + 1] - stops[i]) / 2;
        const bool lit = sees_sun(air.radius_m, ray.altitude(middle), light.sun_cosine(middle));
        if (lit) {
            light.estimate(pieces.emplace_back(InScattering::Piece{stops[i], stops[i + 1], way, {}}));
            add(result.air, pieces.back().value, air.wavelengths);
        }
        way = way + columns_along(air, ray, stops[i], stops[i + 1]);
    }
    const Spectrum scale = result.air;
    result.air.fill(0);
    for (const InScattering::Piece& piece : pieces)
        add(result.air,
            (exact ? settle : settle_quickly)(light, piece, scale, air.wavelengths, 0),
            air.wavelengths);
    result.hits_ground = ray.hits_ground();
    if (!result.hits_ground) return result;
    const double sun = light.sun_cosine(ray.ground());
    if (sun <= 0) return result;
    way = way + columns_past_ground(air, 0, sun);
    for (std::size_t w = 0; w < air.wavelengths; ++w)
        result.ground[w] = air.ground_albedo[w] / kPi * sun * air.transmittance(w, way);
    return result;
}

} // namespace renderer
