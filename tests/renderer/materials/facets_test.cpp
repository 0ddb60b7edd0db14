// Properties that every surface of facets must have: energy, reciprocity, densities, continuity.
#include "renderer/materials/fresnel.h"
#include "renderer/materials/microfacet.h"
#include "renderer/sampling/warp.h"
#include "tests/renderer/materials/every_bsdf.h"
#include "tests/support/chi_square.h"
#include "tests/support/places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

using renderer::Bsdf;
using renderer::Microfacets;
using renderer::Multiscatter;
using renderer::PixelSampler;
using renderer::Rgb;
using renderer::Sample2;
using renderer::Vec3d;
using renderer::Vec3f;
using tests::at_angle;

namespace {

constexpr double kPi = renderer::kPi;

Vec3f at_cosine(double mu)
{
    return renderer::to_float({std::sqrt((1 - mu) * (1 + mu)), 0, mu});
}

struct Energy {
    double reflected = 0, transmitted = 0;
    double all() const { return reflected + transmitted; }
};

bool is_layered(const Bsdf& bsdf)
{
    return bsdf.layers.one_over_missing > 0 || bsdf.layers.base_scale > 0;
}

// The facets' own part.
Bsdf without_layers(Bsdf bsdf)
{
    bsdf.layers.one_over_missing = bsdf.layers.base_scale = 0;
    return bsdf;
}

// Integral of what lies below the facets: it depends on the cosine alone.
double energy_below(const Bsdf& bsdf, double mu, int steps)
{
    const auto roughness = static_cast<double>(bsdf.roughness);
    const renderer::LayerAlbedo o = layer_albedo(bsdf.layers, mu, roughness);
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double t0 = static_cast<double>(i) / steps, t1 = (i + 1.0) / steps, t = (t0 + t1) / 2;
        const renderer::LayerAlbedo wi = layer_albedo(bsdf.layers, t * t * t, roughness);
        // Cosines are t^3: the integral of 2 pi cos dcos is pi t^6.
        sum += kPi * (std::pow(t1, 6) - std::pow(t0, 6)) *
               static_cast<double>(below_facets(bsdf.layers, o, wi).g);
    }
    return sum;
}

// Shares of white light that come back and that pass, the green channel's: by a midpoint rule over the
// facets that wo sees. Where f is large so is its density: their ratio keeps its digits.
Energy energy_of(const Bsdf& bsdf, double mu, int rings, int sectors)
{
    Energy out;
    const Vec3f wo = at_cosine(mu);
    const Vec3d o = renderer::unit_double(wo);
    const double alpha = std::pow(static_cast<double>(bsdf.roughness), 2),
                 eta = static_cast<double>(bsdf.eta);
    const Bsdf bare = without_layers(bsdf);
    const auto weight = [&](Vec3f wi) {
        const renderer::BsdfValue value = evaluate(bare, wo, wi);
        return value.pdf > 0 ? static_cast<double>(value.f.g) / static_cast<double>(value.pdf) : 0;
    };
    for (int i = 0; i < rings; ++i) {
        // Facets that lie almost along wo's horizon lose light: rings are narrow there.
        const double t0 = static_cast<double>(i) / rings, t1 = (i + 1.0) / rings, t = (t0 + t1) / 2;
        const double cell = (t1 * t1 * t1 - t0 * t0 * t0) / sectors;
        for (int j = 0; j < sectors; ++j) {
            const Sample2 u{static_cast<float>((j + 0.5) / sectors), static_cast<float>(1 - t * t * t)};
            const Vec3d h = renderer::sample_visible_facet(alpha, o, u);
            const Vec3d up = h * (2 * dot(o, h)) - o;
            const renderer::DielectricBoundary met = renderer::meet_dielectric(dot(o, h), eta);
            const double reflected = transmits(bsdf) ? met.reflected : 1;
            if (up.z > 0) out.reflected += cell * reflected * weight(renderer::to_float(up));
            if (!transmits(bsdf)) continue;
            const Vec3d down = (h * dot(o, h) - o) / eta - h * met.cos_transmitted;
            if (down.z < 0)
                out.transmitted += cell * (1 - met.reflected) * eta * eta * weight(renderer::to_float(down));
        }
    }
    if (is_layered(bsdf)) out.reflected += energy_below(bsdf, static_cast<double>(wo.z), 1000);
    return out;
}

struct ReferenceAlbedo {
    double roughness, mu, albedo;
};

std::vector<ReferenceAlbedo> reference_albedos()
{
    std::ifstream file(tests::source_dir() + "/../shared/reference/materials/ggx_directional_albedo.csv");
    std::vector<ReferenceAlbedo> rows;
    std::string line;
    while (std::getline(file, line)) {
        ReferenceAlbedo row{};
        double alpha = 0;
        char comma = 0;
        std::istringstream text(line);
        if (text >> row.roughness >> comma >> alpha >> comma >> row.mu >> comma >> row.albedo)
            rows.push_back(row);
    }
    return rows;
}

} // namespace

TEST(Facets, ReflectInAWhiteFurnaceWhatTheReferenceSays)
{
    const std::vector<ReferenceAlbedo> rows = reference_albedos();
    if (rows.empty()) GTEST_SKIP() << "../shared with its reference materials is not here";
    ASSERT_EQ(rows.size(), 132u);
    for (const ReferenceAlbedo& row : rows) {
        const double own = row.roughness <= 0.05 ? 4e-3 : 5e-4; // the reference's error at grazing angles
        EXPECT_NEAR(energy_of(tests::white_facets(row.roughness, Multiscatter::off), row.mu, 256, 128).all(),
                    row.albedo,
                    own)
            << row.roughness << " " << row.mu;
        EXPECT_NEAR(
            energy_of(tests::white_facets(row.roughness, Multiscatter::on), row.mu, 96, 48).all(), 1, 0.01)
            << row.roughness << " " << row.mu;
    }
    EXPECT_NEAR(
        energy_of(tests::white_facets(1, Multiscatter::off), 1, 512, 64).all(), 1 - std::log(2.0), 1e-4);
}

TEST(Facets, NeverGiveMoreLightThanTheyGet)
{
    std::mt19937 random(7);
    const auto unit = [&] { return std::generate_canonical<double, 32>(random); };
    for (int i = 0; i < 10000; ++i) {
        const double mu = std::max(1e-4, unit()), roughness = 0.01 + 0.99 * unit();
        const double ior = std::exp2(20 * unit() - 10);
        const auto multiscatter = unit() < 0.5 ? Multiscatter::off : Multiscatter::on;
        Bsdf bsdf;
        switch (i % 3) {
        case 0: {
            renderer::CookTorranceMaterial m =
                tests::varnish(unit() < 0.5 ? 1 : static_cast<float>(unit()), unit(), roughness, ior);
            m.multiscatter = multiscatter;
            bsdf = make_bsdf(m);
            break;
        }
        case 1: {
            renderer::ConductorMaterial m;
            const auto eta = static_cast<float>(ior), k = static_cast<float>(std::exp2(20 * unit() - 10));
            m.ior = renderer::ComplexIor{{eta, eta, eta}, {k, k, k}};
            m.roughness.value = roughness;
            m.multiscatter = multiscatter;
            bsdf = make_bsdf(m);
            break;
        }
        default:
            bsdf = tests::glass(ior, roughness);
        }
        const double most = 1 + (multiscatter == Multiscatter::on ? 0.01 : 1e-6);
        double energy = energy_of(bsdf, mu, 24, 16).all();
        // A coarse rule may be too high itself.
        if (energy > most) energy = energy_of(bsdf, mu, 400, 200).all();
        ASSERT_LE(energy, most) << "kind " << i % 3 << ", mu " << mu << ", roughness " << roughness
                                << ", ior " << ior;
        ASSERT_GE(energy, 0);
    }
}

TEST(Facets, AddWhatLiesBelowThemToTheirOwnReflection)
{
    for (const double roughness : {0.05, 0.4, 1.0}) {
        renderer::CookTorranceMaterial m = tests::varnish(0.7f, 0.3, roughness);
        m.multiscatter = Multiscatter::on;
        const Bsdf bsdf = make_bsdf(m);
        for (const double out : {0.0, 40.0, 85.0})
            for (const double in : {5.0, 60.0, 89.0}) {
                const Vec3f wo = at_angle(out), wi = at_angle(in, 200);
                const auto at = [&](Vec3f w) {
                    return layer_albedo(bsdf.layers, static_cast<double>(w.z), roughness);
                };
                const double below =
                    static_cast<double>((below_facets(bsdf.layers, at(wo), at(wi)) * wi.z).g);
                const double facets = static_cast<double>(eval(without_layers(bsdf), wo, wi).g);
                EXPECT_NEAR(
                    static_cast<double>(eval(bsdf, wo, wi).g), facets + below, 1e-6 * (facets + below));
            }
    }
}

TEST(Facets, AreReciprocal)
{
    std::mt19937 random(8);
    const auto unit = [&] { return std::generate_canonical<double, 32>(random); };
    const auto direction = [&] {
        return renderer::sample_cosine_hemisphere({static_cast<float>(unit()), static_cast<float>(unit())});
    };
    const auto f = [](const Bsdf& bsdf, Vec3f wo, Vec3f wi) {
        return static_cast<double>(eval(bsdf, wo, wi).g) / std::abs(static_cast<double>(wi.z));
    };
    for (int i = 0; i < 100000; ++i) {
        const double roughness = 0.02 + 0.98 * unit();
        const double ior = std::exp2((i % 2 == 0 ? 1 : -1) * (1 + i / 2 % 3)); // 1 / ior is exact
        const Vec3f a = direction(), b = direction();
        if (!(a.z > 1e-3f) || !(b.z > 1e-3f)) continue;
        Bsdf bsdf;
        if (i % 3 == 0) {
            renderer::CookTorranceMaterial m = tests::varnish(0.7f, unit(), roughness, ior);
            m.multiscatter = Multiscatter::on;
            bsdf = make_bsdf(m);
        } else if (i % 3 == 1) {
            bsdf = tests::conductor(static_cast<float>(ior), 2, roughness);
        } else {
            bsdf = tests::glass(ior, roughness);
        }
        const double ab = f(bsdf, a, b), ba = f(bsdf, b, a);
        ASSERT_NEAR(ab, ba, 1e-6 * ab) << i % 3 << " " << roughness;
        if (!transmits(bsdf)) continue;
        // Across the boundary f / eta^2 of the side that light arrives from is the same both ways.
        Bsdf back = bsdf;
        back.eta = 1 / bsdf.eta;
        const auto turned = [](Vec3f w) { return Vec3f{w.x, w.y, -w.z}; };
        const Vec3f below = turned(b);
        const double there =
            f(bsdf, a, below) * static_cast<double>(bsdf.eta) * static_cast<double>(bsdf.eta);
        const double again = f(back, b, turned(a));
        // At a facet's horizon nothing passes, to the last digits of F.
        ASSERT_NEAR(there, again, 1e-6 * there + 1e-12) << roughness << " " << ior;
    }
}

TEST(Facets, AreDistributedAsTheirDensitiesSay)
{
    // Integrals over tan(theta) = alpha tan(t), in which they are wide.
    for (const double alpha : {1e-6, 1e-4, 0.01, 0.1, 0.25, 0.5, 1.0}) {
        const Microfacets facets(alpha);
        for (const double mu : {1.0, 0.7, 0.1, 1e-3}) {
            double cosines = 0, seen = 0;
            constexpr int kRings = 2000;
            const Vec3d o = renderer::unit_double(at_cosine(mu));
            for (int i = 0; i < kRings; ++i) {
                const double t = (i + 0.5) / kRings * kPi / 2, tangent = alpha * std::tan(t);
                const double c = 1 / std::sqrt(1 + tangent * tangent), s = tangent * c;
                // d omega = sin d theta d phi; d theta = alpha / cos^2(t) c^2 dt
                const double ring = s * alpha * c * c / (std::cos(t) * std::cos(t)) * (kPi / 2 / kRings);
                cosines += ring * 2 * kPi * facets.distribution({s, 0, c}) * c;
                // D is the same all around, so that max(0, o.h) is integrated around in closed form: its kink
                // would cost a sum most of its digits where mu is small.
                const double across = o.x * s, along = o.z * c;
                const double end = across > along ? std::acos(-along / across) : kPi;
                const Vec3d h{s * std::cos(i), s * std::sin(i), c};
                seen += ring * 2 * facets.masking(o.z) * facets.distribution(h) *
                        (across * std::sin(end) + along * end);
            }
            EXPECT_NEAR(cosines, 1, 1e-4) << alpha;
            EXPECT_NEAR(seen / o.z, 1, 1e-4) << alpha << " " << mu;
        }
    }
}

namespace {

// A direction's facet, its slopes over alpha mapped to the sphere around +z: every lobe is as wide as the
// last.
Vec3f widened(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    const Vec3d o = renderer::unit_double(wo), i = renderer::unit_double(wi);
    Vec3d h = wi.z < 0 ? o + i * static_cast<double>(bsdf.eta) : o + i;
    if (h.z < 0) h = -h;
    const double alpha = std::pow(static_cast<double>(bsdf.roughness), 2);
    Vec3d wide = normalize(Vec3d{h.x / alpha, h.y / alpha, h.z});
    // The half sphere of facets, above for what is reflected and below for what passes.
    if (wi.z < 0) wide.z = -wide.z;
    return renderer::to_float(wide);
}

// Density of a widened facet: the Bsdf's own of the direction, over its Jacobians.
double widened_density(const Bsdf& bsdf, Vec3f wo, Vec3f wide)
{
    const Vec3d o = renderer::unit_double(wo), w = renderer::unit_double(wide);
    const double alpha = std::pow(static_cast<double>(bsdf.roughness), 2),
                 eta = static_cast<double>(bsdf.eta);
    const Vec3d stretched{alpha * w.x, alpha * w.y, std::abs(w.z)};
    const double size = length(stretched);
    const Vec3d h = stretched / size;
    const double o_h = dot(o, h);
    if (!(o_h > 0)) return 0;
    const double facet_per_wide = alpha * alpha / (size * size * size); // d h / d wide
    if (w.z > 0) {
        const Vec3f wi = renderer::to_float(h * (2 * o_h) - o);
        return wi.z > 0 ? static_cast<double>(pdf(bsdf, wo, wi)) * 4 * o_h * facet_per_wide : 0;
    }
    const renderer::DielectricBoundary met = renderer::meet_dielectric(o_h, eta);
    const Vec3d wi = (h * o_h - o) / eta - h * met.cos_transmitted;
    if (!transmits(bsdf) || met.reflected >= 1 || !(wi.z < 0)) return 0;
    const double i_h = met.cos_transmitted, along = o_h - eta * i_h;
    return static_cast<double>(pdf(bsdf, wo, renderer::to_float(wi))) * along * along / (eta * eta * i_h) *
           facet_per_wide;
}

} // namespace

TEST(Facets, AreSampledAsTheirDensitySays)
{
    std::vector<tests::NamedBsdf> all;
    for (const double alpha : {1e-3, 0.01, 0.1, 0.25, 1.0}) {
        const double r = std::sqrt(alpha);
        const std::string of = ", alpha " + std::to_string(alpha);
        all.push_back({"conductor" + of, tests::conductor(0.2f, 3.9f, r)});
        all.push_back({"glass" + of, tests::glass(1.5, r)});
        all.push_back({"glass from within" + of, tests::glass_from_within(1.5, r)});
        if (alpha >= 0.1) all.push_back({"varnish" + of, make_bsdf(tests::varnish(0.8f, 0.3, r))});
    }
    const double p_least = 0.01 / (4.0 * static_cast<double>(all.size()));
    for (const auto& [name, bsdf] : all)
        for (const double angle : {0.0, 45.0, 80.0, 89.9}) {
            const Vec3f wo = at_angle(angle);
            const auto draw = [&, &one = bsdf](std::size_t i) {
                const PixelSampler sampler(3, static_cast<std::uint32_t>(i), 8);
                const Vec3f wi = sample(one, wo, sampler.sample_1d(0, 0), sampler.sample_2d(0, 1)).wi;
                return wi == Vec3f{} ? wi : widened(one, wo, wi);
            };
            const auto density = [&, &one = bsdf](Vec3f wide) { return widened_density(one, wo, wide); };
            const auto result = tests::chi_square(100000, draw, density, 24, 16);
            EXPECT_NEAR(result.expected_share, result.drawn_share, 6e-3) << name << " at " << angle;
            EXPECT_GT(result.p_value, p_least)
                << name << " at " << angle << ": " << result.statistic << " for " << result.degrees
                << ", drawn " << result.drawn_share;
        }
}

TEST(Facets, OfRoughnessBelowAThousandthAreMirrors)
{
    for (const double roughness : {0.0, 1e-4, 9.99e-4}) {
        EXPECT_TRUE(is_delta_only(tests::conductor(0.2f, 3.9f, roughness)));
        EXPECT_TRUE(is_delta_only(tests::glass(1.5, roughness)));
        EXPECT_TRUE(is_delta_only(make_bsdf(tests::varnish(0.5f, 1, roughness))));
        EXPECT_FALSE(is_delta_only(make_bsdf(tests::varnish(0.5f, 0, roughness)))); // its base scatters
    }
    // Into the narrowest lobe there is no step.
    for (const double angle : {0.0, 45.0, 80.0}) {
        const Vec3f wo = at_angle(angle);
        const double mu = static_cast<double>(wo.z);
        const auto mirrored = [&](const Bsdf& bsdf) {
            return static_cast<double>(delta_lobes(bsdf, wo).lobes[0].weight.g);
        };
        const double metal = mirrored(tests::conductor(0.2f, 3.9f, 0));
        EXPECT_NEAR(energy_of(tests::conductor(0.2f, 3.9f, 1e-3), mu, 64, 64).all(), metal, 1e-3 * metal);
        const double pane = mirrored(tests::glass(1.5, 0));
        EXPECT_NEAR(energy_of(tests::glass(1.5, 1e-3), mu, 64, 64).reflected, pane, 1e-3 * pane);
        const Bsdf sharp = tests::conductor(0.2f, 3.9f, 1e-3);
        for (std::uint32_t i = 0; i < 1000; ++i) {
            const renderer::BsdfSample draw = sample(sharp, wo, 0.5f, PixelSampler(1, i, 0).sample_2d(0, 0));
            ASSERT_TRUE(std::isfinite(draw.pdf) && std::isfinite(draw.weight.g));
            if (draw.pdf > 0) {
                ASSERT_NEAR(draw.weight.g, metal, 1e-3 * metal);
            }
        }
    }
}
