// Light from surfaces against closed forms: irradiance E over pi L of a point whose normal is known.
//
// Source  J. Howell, "A Catalog of Radiation Heat Transfer Configuration Factors": rectangles, disks; spheres that
//         the horizon cuts: values of numerical integration.
#include "renderer/lights/sample_emitter.h"
#include "renderer/math/transcendental.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace renderer;

namespace {

constexpr Rgb kWhite{1, 1, 1};

struct Estimate {
    double mean, standard_error;
};

// E / (pi L) at `point` with `normal`, by what sample() draws; replicates give the error.
Estimate irradiance(const Emitter& emitter, Vec3d point, Vec3d normal, std::uint32_t samples = 4096)
{
    constexpr std::uint32_t kReplicates = 16;
    double sum = 0, squares = 0;
    for (std::uint32_t r = 0; r < kReplicates; ++r) {
        const PixelSampler numbers(9, r, 0);
        double one = 0;
        for (std::uint32_t i = 0; i < samples; ++i) {
            const EmitterSample s = sample(emitter, point, numbers.sample_2d(i, 0));
            if (s.distance > 0) one += std::max(0.0, dot(s.wi, normal)) / s.pdf;
        }
        one /= samples * kPi;
        sum += one;
        squares += one * one;
    }
    const double mean = sum / kReplicates;
    return {mean, std::sqrt(std::max(0.0, squares / kReplicates - mean * mean) / (kReplicates - 1))};
}

void expect_irradiance(const Emitter& emitter, Vec3d point, Vec3d normal, double want, const char* what)
{
    const Estimate got = irradiance(emitter, point, normal);
    EXPECT_NEAR(got.mean, want, std::max(4 * got.standard_error, 1e-9)) << what;
    EXPECT_LT(got.standard_error, 1e-3 * std::max(want, 0.01)) << what;
}

// A rectangle that shines down, its centre at `at`.
Emitter ceiling(double width, double depth, Vec3d at, bool two_sided = false)
{
    const Affine3 placed =
        Affine3::translate(at) * Affine3::rotate_deg(90, {1, 0, 0}) * Affine3::scale({width, depth, 1});
    return rectangle_emitter(placed, kWhite, two_sided).value();
}

std::vector<std::pair<const char*, Emitter>> every_shape()
{
    const Affine3 placed = Affine3::translate({0.5, 1, -0.25}) * Affine3::rotate_deg(70, {1, 0.3, 0.2});
    const Affine3 sheared = placed * Affine3{{{{1, 0.4, 0}, {0, 1, 0}, {0, 0, 1}}}, {}};
    return {{"triangle", triangle_emitter({0, 1, 0}, {1, 1.2, 0.1}, {0.2, 1.1, 0.9}, kWhite, false).value()},
            {"triangle, two-sided",
             triangle_emitter({0, 1, 0}, {1, 1.2, 0.1}, {0.2, 1.1, 0.9}, kWhite, true).value()},
            {"rectangle", rectangle_emitter(placed * Affine3::scale({2, 0.5, 1}), kWhite, true).value()},
            {"parallelogram", rectangle_emitter(sheared, kWhite, true).value()},
            {"disk", disk_emitter(placed, 0.7, kWhite, true).value()},
            {"ellipse", disk_emitter(sheared, 0.7, kWhite, true).value()},
            {"sphere", sphere_emitter(placed, 0.5, kWhite, false).value()},
            {"ellipsoid", sphere_emitter(sheared * Affine3::scale({1, 2, 0.5}), 0.4, kWhite, false).value()}};
}

constexpr Vec3d kPoints[] = {
    {0, 0, 0}, {3, 0.2, 0.1}, {0.5, 0.3, -0.2}, {0.4, 2.5, 0.2}, {-20, 5, 30}, {0.51, 1.9, -0.24}};

} // namespace

TEST(Emitter, RectangleLightsAPointUnderItsCornerAndUnderItsCentre)
{
    expect_irradiance(ceiling(1, 1, {0.5, 1, 0.5}), {0, 0, 0}, {0, 1, 0}, 0.1385316060, "corner");
    expect_irradiance(ceiling(2, 2, {0, 1, 0}), {0, 0, 0}, {0, 1, 0}, 0.5541264240, "centre");
}

// Lambert's sum over the sides of a polygon all of which is seen: half the angles between its corners, by how much each side's
// plane faces the surface.
double lit_by_polygon(const std::vector<Vec3d>& corners, Vec3d point, Vec3d normal)
{
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = corners[i] - point, b = corners[(i + 1) % corners.size()] - point;
        const Vec3d side = cross(a, b);
        sum += std::atan2(length(side), dot(a, b)) * dot(side, normal) / length(side);
    }
    return std::abs(sum) / (2 * kPi);
}

TEST(Emitter, RectangleLightsAWallThatItsLightGrazes)
{
    const Emitter lamp = ceiling(0.5, 0.4, {0, 1.98, 0});
    const std::vector<Vec3d> corners{
        {-0.25, 1.98, -0.2}, {0.25, 1.98, -0.2}, {0.25, 1.98, 0.2}, {-0.25, 1.98, 0.2}};
    for (const double below : {0.001, 0.01, 0.03, 0.1, 0.5}) {
        const Vec3d point{0.3, 1.98 - below, -1}, normal{0, 0, 1};
        const double want = lit_by_polygon(corners, point, normal);
        const Estimate got = irradiance(lamp, point, normal);
        EXPECT_NEAR(got.mean / want, 1, 1e-4) << below;
    }
}

TEST(Emitter, TwoTrianglesLightAsTheirRectangle)
{
    const Vec3d a{-1, 1, -1}, b{1, 1, -1}, c{1, 1, 1}, d{-1, 1, 1};
    const Emitter one = triangle_emitter(a, b, c, kWhite, false).value(),
                  two = triangle_emitter(a, c, d, kWhite, false).value();
    EXPECT_LT(one.normal.y, 0);
    const double sum =
        irradiance(one, {0, 0, 0}, {0, 1, 0}).mean + irradiance(two, {0, 0, 0}, {0, 1, 0}).mean;
    EXPECT_NEAR(sum, 0.5541264240, 1e-5);
}

TEST(Emitter, DiskOnItsAxisGivesItsClosedForm)
{
    const Affine3 down = Affine3::translate({0, 1, 0}) * Affine3::rotate_deg(90, {1, 0, 0});
    expect_irradiance(disk_emitter(down, 1, kWhite, false).value(), {0, 0, 0}, {0, 1, 0}, 0.5, "r = h");
    expect_irradiance(
        disk_emitter(down, 0.25, kWhite, false).value(), {0, 0, 0}, {0, 1, 0}, 0.0625 / 1.0625, "r = h/4");
}

TEST(Emitter, SphereGivesCosineTimesSineSquaredAndTheHorizonCutsIt)
{
    // sigma = 1 radian: R = sin(1) at distance 1, at the angle omega from the normal.
    const double radius = std::sin(1.0);
    const auto at = [&](double omega_deg) {
        const auto [s, c] = sin_cos_deg(omega_deg);
        return sphere_emitter(Affine3::translate({s, c, 0}), radius, kWhite, false).value();
    };
    expect_irradiance(at(0), {0, 0, 0}, {0, 1, 0}, radius * radius, "0");
    expect_irradiance(at(60), {0, 0, 0}, {0, 1, 0}, 0.388969, "60");
    expect_irradiance(at(80), {0, 0, 0}, {0, 1, 0}, 0.239461, "80");
    expect_irradiance(at(90), {0, 0, 0}, {0, 1, 0}, 0.173591, "90");
    expect_irradiance(at(100), {0, 0, 0}, {0, 1, 0}, 0.116505, "100");
}

TEST(Emitter, IsTheSameFromAMicronToAMillionMetres)
{
    for (const double r : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
        const Emitter e = sphere_emitter(Affine3::translate({0, 2 * r, 0}), r, kWhite, false).value();
        EXPECT_NEAR(irradiance(e, {0, 0, 0}, {0, 1, 0}).mean, 0.25, 1e-6) << r;
        EXPECT_NEAR(power_of(e) / (4 * kPi * kPi * r * r), 1, 1e-12);
    }
    // From very far it is a point: flux / (4 pi d^2).
    const Emitter far = sphere_emitter(Affine3::translate({0, 1e6, 0}), 1, kWhite, false).value();
    EXPECT_NEAR(
        irradiance(far, {0, 0, 0}, {0, 1, 0}).mean * kPi / (power_of(far) / (4 * kPi * 1e12)), 1, 1e-6);
}

TEST(Emitter, DrawsWithTheDensityThatItTells)
{
    for (const auto& [name, emitter] : every_shape())
        for (const Vec3d& point : kPoints)
            for (std::uint32_t i = 0; i < 200; ++i) {
                const EmitterSample s = sample(emitter, point, PixelSampler(3, i, 1).sample_2d(0, 0));
                if (!(s.distance > 0)) continue;
                EXPECT_NEAR(length(s.wi), 1, 1e-12) << name;
                EXPECT_NEAR(pdf(emitter, point, point + s.wi * s.distance) / s.pdf, 1, 1e-5)
                    << name << " " << i;
            }
}

TEST(Emitter, DrawsUniformlyWhatIsSeen)
{
    // The mean of 1 / pdf is the solid angle, whichever way it was drawn; by area from another shape of the same
    // outline it must be the same.
    for (const Vec3d& point : kPoints) {
        const Affine3 placed = Affine3::translate({0.5, 1, -0.25}) * Affine3::rotate_deg(70, {1, 0.3, 0.2});
        Emitter rectangle = rectangle_emitter(placed, kWhite, true).value(), by_area = rectangle;
        by_area.is_rectangle = false;
        const auto mean = [&](const Emitter& e, Vec3d way) {
            double sum = 0;
            const PixelSampler numbers(4, 2, 2);
            for (std::uint32_t i = 0; i < 65536; ++i) {
                const EmitterSample s = sample(e, point, numbers.sample_2d(i, 0));
                if (s.distance > 0) sum += (1 + dot(s.wi, way)) / s.pdf;
            }
            return sum / 65536;
        };
        for (const Vec3d& way : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
            EXPECT_NEAR(mean(rectangle, way) / mean(by_area, way), 1, 3e-3) << point.x;
    }
}

TEST(Emitter, MirroredRectangleIsDrawnFromAsItsTwin)
{
    const Affine3 placed = Affine3::translate({0.3, -0.2, 2}) * Affine3::rotate_deg(25, {1, 2, 3});
    const Emitter plain = rectangle_emitter(placed * Affine3::scale({2, 0.5, 1}), kWhite, true).value();
    const PixelSampler numbers(4, 1, 0);
    for (const Vec3d factors :
         {Vec3d{-2, 0.5, 1}, Vec3d{2, -0.5, 1}, Vec3d{2, 0.5, -1}, Vec3d{-2, -0.5, -1}}) {
        const Emitter mirrored = rectangle_emitter(placed * Affine3::scale(factors), kWhite, true).value();
        const Affine3 back = placed.inverse().value();
        for (std::uint32_t i = 0; i < 64; ++i) {
            const EmitterSample s = sample(mirrored, {}, numbers.sample_2d(i, 0));
            ASSERT_GT(s.distance, 0);
            const Vec3d at = back.point(s.wi * s.distance);
            EXPECT_LE(std::abs(at.x), 1 + 1e-12);
            EXPECT_LE(std::abs(at.y), 0.25 + 1e-12);
            EXPECT_NEAR(at.z, 0, 1e-12);
            EXPECT_NEAR(s.pdf / pdf(plain, {}, s.wi * s.distance), 1, 1e-9);
        }
    }
}

TEST(Emitter, GivesNothingBehindAndInItsPlane)
{
    const Emitter e = ceiling(1, 1, {0, 1, 0});
    for (const Vec3d& point : {Vec3d{0, 2, 0}, Vec3d{0, 1, 0}, Vec3d{5, 1, 0}}) {
        EXPECT_EQ(sample(e, point, {0.3f, 0.6f}).distance, 0);
        EXPECT_EQ(pdf(e, point, {0, 1, 0}), 0);
    }
    const Emitter both = ceiling(1, 1, {0, 1, 0}, true);
    EXPECT_GT(sample(both, {0, 2, 0}, {0.3f, 0.6f}).distance, 0);
    EXPECT_EQ(sample(both, {5, 1, 0}, {0.3f, 0.6f}).distance, 0);
    const Emitter ball = sphere_emitter({}, 1, kWhite, false).value();
    EXPECT_EQ(sample(ball, {0.5, 0, 0}, {0.3f, 0.6f}).distance, 0) << "its inside does not shine";
}

TEST(Emitter, IsFiniteAMicronAway)
{
    for (const auto& [name, emitter] : every_shape()) {
        if (emitter.normal == Vec3d{}) continue;
        const Vec3d inner =
            emitter.corner +
            (emitter.shape == EmitterShape::disk ? Vec3d{} : (emitter.side_u + emitter.side_v) / 3.0);
        const Vec3d point = inner + emitter.normal * 1e-6;
        for (std::uint32_t i = 0; i < 1000; ++i) {
            const EmitterSample s = sample(emitter, point, PixelSampler(3, i, 1).sample_2d(0, 0));
            ASSERT_TRUE(std::isfinite(s.pdf) && std::isfinite(s.distance)) << name;
            ASSERT_TRUE(s.distance == 0 || s.pdf > 0) << name;
        }
    }
}

TEST(Emitter, FillsASphereFromWithin)
{
    const Emitter ball = sphere_emitter({}, 2, kWhite, true).value();
    for (const Vec3d& point : {Vec3d{0, 0, 0}, Vec3d{1.5, 0.3, 0}}) {
        const Estimate got = irradiance(ball, point, {0, 1, 0}, 16384);
        EXPECT_NEAR(got.mean, 1, std::max(4 * got.standard_error, 1e-6));
    }
}

TEST(Emitter, OfPowerHasTheRadianceThatGivesIt)
{
    for (const auto& [name, emitter] : every_shape()) {
        Emitter e = emitter;
        e.radiance = radiance_of_power({10, 10, 10}, e);
        EXPECT_NEAR(power_of(e), 10, 1e-5) << name;
    }
    // A prolate ellipsoid of axes 2, 1, 1: 2 pi (1 + 2 / e asin e), e^2 = 3 / 4.
    const double e = std::sqrt(0.75);
    const Emitter egg = sphere_emitter(Affine3::scale({2, 1, 1}), 1, kWhite, false).value();
    EXPECT_NEAR(egg.area, 2 * kPi * (1 + 2 / e * std::asin(e)), 1e-3);
}

TEST(Emitter, OfSquareToSquareHasTheFormFactorsOfTheCatalog)
{
    // Mean over a unit receiver around the origin that faces +y.
    const auto factor = [](const Emitter& emitter) {
        double sum = 0;
        constexpr std::uint32_t kPoints = 4096;
        const PixelSampler places(8, 0, 0), numbers(8, 1, 1);
        for (std::uint32_t i = 0; i < kPoints; ++i) {
            const Sample2 at = places.sample_2d(i, 0);
            const Vec3d point{static_cast<double>(at.u0) - 0.5, 0, static_cast<double>(at.u1) - 0.5};
            double one = 0;
            for (std::uint32_t k = 0; k < 16; ++k) {
                const EmitterSample s = sample(emitter, point, numbers.sample_2d(16 * i + k, 0));
                if (s.distance > 0) one += std::max(0.0, s.wi.y) / s.pdf;
            }
            sum += one / 16;
        }
        return sum / kPoints / kPi;
    };
    EXPECT_NEAR(factor(ceiling(1, 1, {0, 1, 0})), 0.1998248957, 2e-4);
    EXPECT_NEAR(factor(ceiling(1, 1, {0, 0.1, 0})), 0.8269945224, 8e-4);
    EXPECT_NEAR(factor(ceiling(1, 1, {0, 10, 0})), 3.16205684e-3, 3e-6);
    const Affine3 wall = Affine3::translate({-0.5, 0.5, 0}) * Affine3::rotate_deg(90, {0, 1, 0});
    EXPECT_NEAR(factor(rectangle_emitter(wall, kWhite, false).value()), 0.2000437761, 3e-4);
}

TEST(Emitter, IsCutByTheHorizon)
{
    // Half of a wall stands below the ground: it lights as the upper half alone.
    const auto wall = [](double height, double middle) {
        const Affine3 placed = Affine3::translate({-2, middle, 0}) * Affine3::rotate_deg(90, {0, 1, 0}) *
                               Affine3::scale({3, height, 1});
        return rectangle_emitter(placed, kWhite, false).value();
    };
    EXPECT_NEAR(irradiance(wall(4, 0), {0, 0, 0}, {0, 1, 0}).mean,
                irradiance(wall(2, 1), {0, 0, 0}, {0, 1, 0}).mean,
                1e-4);
}

TEST(Emitter, AllAroundFillsTheHemisphere)
{
    // Six walls of a box around a point: their form factors add up to 1.
    for (const Vec3d& point : {Vec3d{0, 0, 0}, Vec3d{0.9, -0.3, 0.4}}) {
        double sum = 0;
        for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
            for (const double side : {-1.0, 1.0}) {
                const Affine3 turn = axis.x != 0   ? Affine3::rotate_deg(90, {0, 1, 0})
                                     : axis.y != 0 ? Affine3::rotate_deg(90, {1, 0, 0})
                                                   : Affine3{};
                const Affine3 placed = Affine3::translate(axis * side) * turn * Affine3::scale({2, 2, 1});
                sum += irradiance(
                           rectangle_emitter(placed, kWhite, true).value(), point, normalize(Vec3d{1, 2, -1}))
                           .mean;
            }
        EXPECT_NEAR(sum, 1, 1e-4);
    }
}
