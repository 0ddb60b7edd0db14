#include "renderer/materials/facet_albedo.h"
#include "tests/support/places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

using renderer::FacetAlbedo;
using renderer::FacetAlbedoTable;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kRows = FacetAlbedoTable::kRows, kColumns = FacetAlbedoTable::kColumns;

// The albedo by a midpoint rule over visible facets: written apart from the renderer's own.
FacetAlbedo integrate(double mu, double roughness, int rings, int sectors)
{
    const double a = roughness * roughness;
    mu = std::clamp(mu, 1e-9, 1.0);
    const double s = std::sqrt((1 - mu) * (1 + mu)), size = std::hypot(a * s, mu);
    const double wx = a * s / size, wz = mu / size;
    const auto slope = [&](double m) { return std::sqrt(a * a + (1 - a * a) * m * m); };
    FacetAlbedo sum{0, 0};
    for (int i = 0; i < rings; ++i) {
        // Facets that lie almost along wo's horizon lose light: rings are narrow there.
        const double t = (i + 0.5) / rings, ring = 3 * t * t;
        const double z = t * t * t * (1 + wz) - wz, sine = std::sqrt((1 - z) * (1 + z));
        for (int j = 0; j < sectors; ++j) {
            const double phi = kPi * (j + 0.5) / sectors; // half a turn: the rest is its mirror image
            const double x = a * (sine * std::cos(phi) + wx), y = a * sine * std::sin(phi), up = z + wz;
            const double scale = 1 / std::sqrt(x * x + y * y + up * up);
            const double c = (s * x + mu * up) * scale, out = 2 * c * up * scale - mu;
            if (!(out > 0)) continue;
            const double seen = ring * out * (mu + slope(mu)) / (mu * slope(out) + out * slope(mu));
            sum.white += seen;
            sum.slanted += seen * std::pow(1 - c, 5);
        }
    }
    const double n = static_cast<double>(rings) * sectors;
    return {sum.white / n, sum.slanted / n};
}

double roughness_of(double row)
{
    return 1e-3 + (1 - 1e-3) * row / (kRows - 1);
}

double cosine_of(double column, double roughness)
{
    const double x = column / (kColumns - 1), across = x * x, a2 = std::pow(roughness, 4);
    // across = c / sqrt(a2 + (1 - a2) c^2), solved for c.
    return across * std::sqrt(a2) / std::sqrt(1 - across * across * (1 - a2));
}

// Twice the integral of cos times what the table says.
FacetAlbedo average_of(const FacetAlbedoTable& table, double roughness)
{
    constexpr int kSteps = 4000;
    FacetAlbedo sum{0, 0};
    for (int i = 0; i < kSteps; ++i) {
        // In the square root of the cosine's root: fine where the table rises.
        const double t0 = static_cast<double>(i) / kSteps, t1 = (i + 1.0) / kSteps, t = (t0 + t1) / 2;
        const double c = t * t * t;
        const FacetAlbedo at = facet_albedo(table, c, roughness);
        const double weight = std::pow(t1, 6) - std::pow(t0, 6); // integral of 2 c dc
        sum.white += weight * at.white;
        sum.slanted += weight * at.slanted;
    }
    return sum;
}

// The integral's own error, and a float's.
double margin(std::size_t column)
{
    return column < 2 ? 2e-4 : 8e-5; // near the horizon the truth is steep between the places it is held at
}

constexpr std::size_t kFine = 5, kFineAcross = 9; // places at which a cell is held against the truth

struct Cell {
    std::array<std::array<FacetAlbedo, kFineAcross>, kFine> truth;
};

double row_place(std::size_t row, std::size_t place)
{
    return static_cast<double>(row) + static_cast<double>(place) / (kFine - 1);
}

// The last column holds most cosines where a surface is smooth: there in even steps.
double cosine_place(std::size_t column, std::size_t place, double roughness)
{
    const double f = static_cast<double>(place) / (kFineAcross - 1);
    if (column + 2 < kColumns) return cosine_of(static_cast<double>(column) + f, roughness);
    const double first = cosine_of(static_cast<double>(column), roughness);
    return first + f * (1 - first);
}

// By how much the table lies below the truth at worst within a cell, in one of its values.
double below(const FacetAlbedoTable& table,
             const Cell& cell,
             std::size_t row,
             std::size_t column,
             double FacetAlbedo::*value)
{
    double worst = 0;
    for (std::size_t i = 0; i < kFine; ++i)
        for (std::size_t j = 0; j < kFineAcross; ++j) {
            const double r = roughness_of(row_place(row, i)), c = cosine_place(column, j, r);
            worst =
                std::max(worst, cell.truth[i][j].*value + margin(column) - facet_albedo(table, c, r).*value);
        }
    return worst;
}

// Raises the corners of every cell until it lies on or above the truth within: white first, since slanted
// rests on it.
void raise(FacetAlbedoTable& table, int rings, int sectors)
{
    std::vector<Cell> cells((kRows - 1) * (kColumns - 1));
    for (std::size_t row = 0; row + 1 < kRows; ++row)
        for (std::size_t column = 0; column + 1 < kColumns; ++column)
            for (std::size_t i = 0; i < kFine; ++i)
                for (std::size_t j = 0; j < kFineAcross; ++j) {
                    const double r = roughness_of(row_place(row, i)), c = cosine_place(column, j, r);
                    cells[row * (kColumns - 1) + column].truth[i][j] = integrate(c, r, rings, sectors);
                }
    const auto raise_one = [&](auto& values, double FacetAlbedo::*value) {
        auto raised = values;
        for (std::size_t row = 0; row + 1 < kRows; ++row)
            for (std::size_t column = 0; column + 1 < kColumns; ++column) {
                const double by = below(table, cells[row * (kColumns - 1) + column], row, column, value);
                for (const std::size_t r : {row, row + 1})
                    for (const std::size_t c : {column, column + 1})
                        raised[r][c] = std::max(raised[r][c], values[r][c] + static_cast<float>(by));
            }
        values = raised;
    };
    // A corner at 1 cannot be raised: its neighbours are, again and again.
    for (int again = 0; again < 16; ++again) {
        raise_one(table.white, &FacetAlbedo::white);
        for (auto& row : table.white)
            for (float& white : row)
                white = std::min(white, 1.0f);
    }
    raise_one(table.slanted, &FacetAlbedo::slanted);
}

FacetAlbedoTable make_table()
{
    constexpr int kRings = 128, kSectors = 64;
    FacetAlbedoTable table{};
    for (std::size_t row = 0; row < kRows; ++row)
        for (std::size_t column = 0; column < kColumns; ++column) {
            const double r = roughness_of(static_cast<double>(row)),
                         c = cosine_of(static_cast<double>(column), r);
            const FacetAlbedo truth = integrate(c, r, kRings, kSectors);
            table.white[row][column] = static_cast<float>(truth.white);
            table.slanted[row][column] = static_cast<float>(truth.slanted - truth.white * std::pow(1 - c, 5));
        }
    raise(table, kRings, kSectors);
    // Averages: of the table as it is read, and by what a straight line between rows would be on the wrong
    // side.
    std::array<double, kRows> white_high{}, slanted_high{};
    const auto missing = [&](double roughness) {
        const FacetAlbedo at = average_of(table, roughness);
        return FacetAlbedo{(1 - at.white) / (roughness * roughness), at.slanted};
    };
    for (std::size_t row = 0; row < kRows; ++row) {
        const FacetAlbedo at = missing(roughness_of(static_cast<double>(row)));
        table.white_missing[row] = static_cast<float>(at.white);
        table.slanted_average[row] = static_cast<float>(at.slanted);
    }
    for (std::size_t row = 0; row + 1 < kRows; ++row)
        for (const double f : {0.1, 0.25, 0.5, 0.75, 0.9}) {
            const FacetAlbedo at = missing(roughness_of(static_cast<double>(row) + f));
            const auto line = [&](const auto& values) {
                return (1 - f) * static_cast<double>(values[row]) + f * static_cast<double>(values[row + 1]);
            };
            for (const std::size_t r : {row, row + 1}) {
                white_high[r] = std::max(white_high[r], at.white - line(table.white_missing));
                slanted_high[r] = std::max(slanted_high[r], line(table.slanted_average) - at.slanted);
            }
        }
    for (std::size_t row = 0; row < kRows; ++row) {
        table.white_missing[row] =
            1.005f * (table.white_missing[row] + static_cast<float>(white_high[row])) + 1e-4f;
        table.slanted_average[row] -= static_cast<float>(slanted_high[row] + 2e-6);
    }
    return table;
}

template <typename Values>
void write_row(std::ostream& out, const Values& values)
{
    out << "{";
    for (std::size_t i = 0; i < values.size(); ++i)
        out << (i == 0        ? ""
                : i % 12 == 0 ? ",\n      "
                              : ", ")
            << std::fixed << std::setprecision(6) << values[i] << "f";
    out << "}";
}

template <typename Rows>
void write_rows(std::ostream& out, const Rows& rows)
{
    out << "    {{\n";
    for (const auto& row : rows) {
        out << "     {";
        write_row(out, row);
        out << "},\n";
    }
    out << "    }},\n";
}

std::string written(const FacetAlbedoTable& table)
{
    std::ostringstream out;
    out << "// Computed by tests/renderer/materials/facet_albedo_test.cpp from GGX facets of "
           "height-correlated Smith masking (E.\n"
           "// Heitz, JCGT 3(2), 2014); upper bounds between the places as well, averages lower ones.\n"
           "// HELIOGRAPH_WRITE_FACET_ALBEDO=1 renderer_tests --gtest_filter='FacetAlbedo.*' writes it "
           "anew.\n"
           "// clang-format off\n"
           "#include \"renderer/materials/facet_albedo.h\"\n\n"
           "namespace renderer {\n\n"
           "const FacetAlbedoTable kFacetAlbedo{\n";
    write_rows(out, table.white);
    write_rows(out, table.slanted);
    for (const auto* const row : {&table.white_missing, &table.slanted_average}) {
        out << "    {";
        write_row(out, *row);
        out << "},\n";
    }
    out << "};\n\n} // namespace renderer\n";
    return out.str();
}

} // namespace

TEST(FacetAlbedo, LiesOnOrAboveTheIntegralAndNearIt)
{
    if (std::getenv("HELIOGRAPH_WRITE_FACET_ALBEDO")) {
        const std::string text = written(make_table());
        std::ofstream(tests::source_dir() + "/renderer/materials/facet_albedo_data.cpp") << text;
        GTEST_SKIP() << "written anew: build again";
    }
    double worst_white = 0, worst_slanted = 0;
    for (int i = 0; i < 1500; ++i) {
        // Additive recurrence of two irrational steps: places that no grid of the table's shares.
        const double x = std::fmod(i * 0.7548776662466927, 1), y = std::fmod(i * 0.5698402909980532, 1);
        const double roughness = roughness_of(y * (kRows - 1));
        const double cosine = i % 2 == 0 ? cosine_of(x * (kColumns - 1), roughness) : x;
        const FacetAlbedo truth = integrate(cosine, roughness, 128, 64);
        const FacetAlbedo read = renderer::facet_albedo(cosine, roughness);
        ASSERT_GE(read.white, truth.white - 1e-6) << cosine << " " << roughness;
        ASSERT_GE(read.slanted, truth.slanted - 1e-6) << cosine << " " << roughness;
        worst_white = std::max(worst_white, read.white - truth.white);
        worst_slanted = std::max(worst_slanted, read.slanted - truth.slanted);
    }
    EXPECT_LT(worst_white, 0.013);
    EXPECT_LT(worst_slanted, 0.013);
}

TEST(FacetAlbedo, AveragesToNoMoreThanItsOwnIntegral)
{
    for (int i = 0; i < 200; ++i) {
        const double roughness = 1e-3 + (1 - 1e-3) * i / 199;
        const FacetAlbedo truth = average_of(renderer::kFacetAlbedo, roughness);
        const FacetAlbedo read = renderer::average_facet_albedo(roughness);
        EXPECT_LE(read.white, truth.white) << roughness;
        EXPECT_LE(read.slanted, truth.slanted) << roughness;
        EXPECT_NEAR(read.white, truth.white, 0.03 * (1 - truth.white) + 1e-5) << roughness;
        EXPECT_NEAR(read.slanted, truth.slanted, 1e-3) << roughness;
    }
}

TEST(FacetAlbedo, OfASmoothSurfaceIsTheFresnelTermItself)
{
    EXPECT_EQ(renderer::facet_albedo(0.25, 0).white, 1);
    EXPECT_NEAR(renderer::facet_albedo(0.25, 0).slanted, std::pow(0.75, 5), 1e-15);
    EXPECT_NEAR(renderer::average_facet_albedo(0).slanted, 1.0 / 21, 1e-15);
    // And is gone to without a step.
    for (const double c : {0.01, 0.25, 0.9}) {
        EXPECT_NEAR(renderer::facet_albedo(c, 1.0001e-3).white, 1, 2e-4);
        EXPECT_NEAR(renderer::facet_albedo(c, 1.0001e-3).slanted, std::pow(1 - c, 5), 2e-3);
    }
}
