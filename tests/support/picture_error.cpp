#include "tests/support/picture_error.h"

#include "renderer/film/encode_png.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace tests {

using renderer::LinearImage;
using renderer::Rgb;

namespace {

double overall_mean(const LinearImage& image)
{
    const Rgb m = mean_of(image);
    return (static_cast<double>(m.r) + static_cast<double>(m.g) + static_cast<double>(m.b)) / 3;
}

void write_png(const std::filesystem::path& path, const LinearImage& image)
{
    const auto bytes = encode_png(develop(image, {}));
    std::ofstream file(path, std::ios::binary);
    for (const std::uint8_t byte : bytes)
        file.put(static_cast<char>(byte));
}

} // namespace

std::optional<LinearImage> read_pfm(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    std::string magic;
    LinearImage image;
    double scale = 0;
    if (!(file >> magic >> image.width_px >> image.height_px >> scale) || magic != "PF" || scale >= 0)
        return std::nullopt;
    file.get();
    image.pixels.resize(std::size_t{image.width_px} * image.height_px);
    for (std::uint32_t y = image.height_px; y-- > 0;)
        for (std::uint32_t x = 0; x < image.width_px; ++x) {
            char bytes[12];
            if (!file.read(bytes, sizeof bytes)) return std::nullopt;
            Rgb& pixel = image.pixels[std::size_t{y} * image.width_px + x];
            std::memcpy(&pixel.r, bytes, 4);
            std::memcpy(&pixel.g, bytes + 4, 4);
            std::memcpy(&pixel.b, bytes + 8, 4);
        }
    return image;
}

Rgb mean_of(const LinearImage& image)
{
    renderer::RgbSum sum;
    for (const Rgb& pixel : image.pixels)
        sum += pixel;
    const auto n = static_cast<double>(image.pixels.size());
    return {static_cast<float>(sum.r / n), static_cast<float>(sum.g / n), static_cast<float>(sum.b / n)};
}

LinearImage in_squares(const LinearImage& image, std::uint32_t side)
{
    LinearImage squares{image.width_px / side, image.height_px / side, {}};
    for (std::uint32_t y = 0; y < squares.height_px; ++y)
        for (std::uint32_t x = 0; x < squares.width_px; ++x) {
            LinearImage square{side, side, {}};
            for (std::uint32_t row = 0; row < side; ++row) {
                const Rgb* const first = image.pixels.data() +
                                         (std::size_t{y} * side + row) * image.width_px +
                                         std::size_t{x} * side;
                square.pixels.insert(square.pixels.end(), first, first + side);
            }
            squares.pixels.push_back(mean_of(square));
        }
    return squares;
}

double relative_rmse(const LinearImage& image, const LinearImage& reference)
{
    const double floor = 0.2 * overall_mean(reference), e = floor * floor;
    double sum = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        const Rgb &a = image.pixels[i], &b = reference.pixels[i];
        for (const auto& [x, ref] : {std::pair{a.r, b.r}, {a.g, b.g}, {a.b, b.b}}) {
            const double d = static_cast<double>(x) - static_cast<double>(ref);
            sum += d * d / (static_cast<double>(ref) * static_cast<double>(ref) + e);
        }
    }
    return std::sqrt(sum / static_cast<double>(3 * reference.pixels.size()));
}

void expect_looks_as(const std::string& name,
                     const LinearImage& image,
                     const LinearImage& reference,
                     double most,
                     double most_of_mean)
{
    const double error = relative_rmse(image, reference);
    EXPECT_LT(error, most) << leave_for_inspection(name, image, reference);
    const Rgb got = mean_of(image), want = mean_of(reference);
    EXPECT_NEAR(got.r / want.r, 1, most_of_mean);
    EXPECT_NEAR(got.g / want.g, 1, most_of_mean);
    EXPECT_NEAR(got.b / want.b, 1, most_of_mean);
    testing::Test::RecordProperty("relative_rmse", std::to_string(error));
}

std::string
leave_for_inspection(const std::string& name, const LinearImage& image, const LinearImage& reference)
{
    const auto folder = std::filesystem::temp_directory_path();
    LinearImage error = reference;
    const auto scale = static_cast<float>(10 / overall_mean(reference));
    for (std::size_t i = 0; i < error.pixels.size(); ++i) {
        const Rgb &a = image.pixels[i], &b = reference.pixels[i];
        error.pixels[i] = Rgb{std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)} * scale;
    }
    write_png(folder / (name + ".png"), image);
    write_png(folder / (name + "_reference.png"), reference);
    write_png(folder / (name + "_error.png"), error);
    return "see " + (folder / (name + "*.png")).string();
}

} // namespace tests
