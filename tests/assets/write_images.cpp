#include "tests/assets/write_images.h"

#include "tests/assets/broken_file.h"
#include "tests/assets/write_files.h"

#include <array>
#include <functional>
#include <vector>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace tests {
namespace {

// Most significant byte first, as PNG has it.
std::string big(std::uint32_t value, int bytes = 4)
{
    std::string out;
    for (int i = bytes - 1; i >= 0; --i)
        out += static_cast<char>(value >> (8 * i) & 0xff);
    return out;
}

std::uint32_t crc_of(std::string_view bytes)
{
    std::uint32_t crc = 0xffffffffu;
    for (const char c : bytes) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit)
            crc = crc >> 1 ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
    }
    return ~crc;
}

std::uint32_t adler_of(std::string_view bytes)
{
    std::uint32_t a = 1, b = 0;
    for (const char c : bytes) {
        a = (a + static_cast<unsigned char>(c)) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

// One stored block: at most 65535 bytes.
std::string stored(std::string_view bytes)
{
    std::string out = "\x78\x01\x01";
    const auto size = static_cast<std::uint16_t>(bytes.size());
    append(out, size);
    append(out, static_cast<std::uint16_t>(~size));
    return out + std::string(bytes) + big(adler_of(bytes));
}

const std::string kMark = "\x89PNG\r\n\x1a\n";

std::string header(std::uint32_t width, std::uint32_t height, const PngForm& form)
{
    std::string content = big(width) + big(height);
    for (const std::uint8_t byte :
         {form.bits, form.color_type, std::uint8_t{0}, std::uint8_t{0}, form.interlace})
        content += static_cast<char>(byte);
    return png_chunk("IHDR", content);
}

// Rows of the pattern with `channels` bytes a pixel, or twice as many.
std::string pattern_rows(std::uint32_t channels, bool twice = false)
{
    std::string rows;
    for (std::uint32_t y = 0; y < kPatternHeight; ++y) {
        rows += '\0';
        for (std::uint32_t x = 0; x < kPatternWidth; ++x)
            for (std::uint32_t c = 0; c < channels; ++c) {
                rows += static_cast<char>(pattern(x, y, c));
                if (twice) rows += static_cast<char>(17); // the lower byte
            }
    }
    return rows;
}

std::string pattern_png(std::uint8_t bits, std::uint8_t color_type, std::uint32_t channels)
{
    return png_bytes(
        kPatternWidth, kPatternHeight, {bits, color_type, 0}, pattern_rows(channels, bits == 16));
}

// The rows and columns of each of the seven passes.
std::string interlaced_png()
{
    constexpr std::array<std::array<std::uint32_t, 4>, 7> kPasses{
        {{0, 8, 0, 8}, {4, 8, 0, 8}, {0, 4, 4, 8}, {2, 4, 0, 4}, {0, 2, 2, 4}, {1, 2, 0, 2}, {0, 1, 1, 2}}};
    std::string rows;
    for (const auto& [x0, dx, y0, dy] : kPasses) {
        if (x0 >= kPatternWidth) continue;
        for (std::uint32_t y = y0; y < kPatternHeight; y += dy) {
            rows += '\0';
            for (std::uint32_t x = x0; x < kPatternWidth; x += dx)
                for (std::uint32_t c = 0; c < 3; ++c)
                    rows += static_cast<char>(pattern(x, y, c));
        }
    }
    return png_bytes(kPatternWidth, kPatternHeight, {8, 2, 1}, rows);
}

// Palette entry i is the pattern's colour of pixel i, so that the picture is the pattern again.
std::string palette_png(bool with_alpha)
{
    std::string palette, alphas, rows;
    for (std::uint32_t y = 0; y < kPatternHeight; ++y) {
        rows += '\0';
        for (std::uint32_t x = 0; x < kPatternWidth; ++x) {
            for (std::uint32_t c = 0; c < 3; ++c)
                palette += static_cast<char>(pattern(x, y, c));
            alphas += static_cast<char>(pattern(x, y, 3));
            rows += static_cast<char>(y * kPatternWidth + x);
        }
    }
    const std::string chunks =
        png_chunk("PLTE", palette) + (with_alpha ? png_chunk("tRNS", alphas) : std::string());
    return png_bytes(kPatternWidth, kPatternHeight, {8, 3, 0}, rows, chunks);
}

std::string encoded(const std::function<int(stbi_write_func*, void*)>& write)
{
    std::string out;
    write(
        [](void* to, void* data, int size) {
            static_cast<std::string*>(to)->append(static_cast<const char*>(data),
                                                  static_cast<std::size_t>(size));
        },
        &out);
    return out;
}

std::vector<unsigned char> pattern_pixels(std::uint32_t channels)
{
    std::vector<unsigned char> pixels;
    for (std::uint32_t y = 0; y < kPatternHeight; ++y)
        for (std::uint32_t x = 0; x < kPatternWidth; ++x)
            for (std::uint32_t c = 0; c < channels; ++c)
                pixels.push_back(pattern(x, y, c));
    return pixels;
}

std::string pattern_jpeg()
{
    const auto pixels = pattern_pixels(3);
    return encoded([&](stbi_write_func* to, void* out) {
        return stbi_write_jpg_to_func(to, out, kPatternWidth, kPatternHeight, 3, pixels.data(), 100);
    });
}

// One block of 8 x 8 without a coefficient: the grey 128. Each of both code tables has one code, of one bit.
std::string grey_jpeg()
{
    const std::string steps(64, '\x01'), counts = '\x01' + std::string(15, '\0');
    const auto segment = [](char marker, const std::string& content) {
        return std::string("\xff") + marker + big(static_cast<std::uint32_t>(content.size() + 2), 2) +
               content;
    };
    return "\xff\xd8" + segment('\xdb', '\0' + steps) +
           segment('\xc0', std::string("\x08\0\x08\0\x08\x01\x01\x11\0", 9)) +
           segment('\xc4', '\0' + counts + '\0') + segment('\xc4', '\x10' + counts + '\0') +
           segment('\xda', std::string("\x01\x01\0\0\x3f\0", 6)) + "\x3f\xff\xd9";
}

std::string pattern_tga(int channels, bool runs)
{
    const auto pixels = pattern_pixels(static_cast<std::uint32_t>(channels));
    stbi_write_tga_with_rle = runs ? 1 : 0;
    return encoded([&](stbi_write_func* to, void* out) {
        return stbi_write_tga_to_func(to, out, kPatternWidth, kPatternHeight, channels, pixels.data());
    });
}

// Light of (x + 1) (y + 1) / 8 times 1, 2, 4: exact in RGBE. 16 wide, so that rows have new run lengths.
std::string light_hdr()
{
    std::vector<float> light;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 16; ++x)
            for (const float scale : {1.0f, 2.0f, 4.0f})
                light.push_back(static_cast<float>((x + 1) * (y + 1)) / 8 * scale);
    return encoded([&](stbi_write_func* to, void* out) {
        return stbi_write_hdr_to_func(to, out, 16, 4, 3, light.data());
    });
}

// 2 x 2, pixels as they are, and 3 x 1 with an old run length.
const std::string kHdrHead = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
std::string flat_hdr()
{
    return kHdrHead + "-Y 2 +X 2\n" +
           std::string("\x80\x40\x20\x81\x80\x80\x80\x80\0\0\0\0\x10\x20\x30\x88", 16);
}
std::string old_runs_hdr()
{
    return kHdrHead + "-Y 1 +X 3\n" + std::string("\x80\x40\x20\x81\x01\x01\x01\x02", 8);
}

// 33 x 33 of 1 x 1 in palette form and run lengths: a palette that begins at 2.
std::string palette_tga(int index)
{
    std::string head(18, '\0');
    head[1] = 1;
    head[2] = 1;
    head[3] = 2;  // first
    head[5] = 1;  // one colour
    head[7] = 24; // bits
    head[12] = 1;
    head[14] = 1;
    head[16] = 8;
    return head + "\x03\x02\x01" + static_cast<char>(index);
}

std::string with_word(std::string bytes, std::size_t at, const std::string& word)
{
    return bytes.replace(at, word.size(), word);
}

std::vector<BrokenFile> broken_images()
{
    const std::string png = pattern_png(8, 2, 3), jpeg = pattern_jpeg(), hdr = light_hdr();
    const std::size_t frame = jpeg.find("\xff\xc0");
    const std::string animation = png_chunk("acTL", big(2) + big(0));
    std::string flipped = png;
    flipped[flipped.find("IDAT") + 30] ^= 1;
    std::string gif = "GIF89a";
    gif += std::string("\x01\0\x01\0\x80\0\0\0\0\0\xff\xff\xff", 13);
    for (int frame_number = 0; frame_number < 2; ++frame_number)
        gif += std::string(",\0\0\0\0\x01\0\x01\0\0\x02\x02\x44\x01\0", 15);
    gif += ';';
    return {
        {"empty.png", "unknown_format", "has no bytes", ""},
        {"words.png", "unknown_format", "is words", "this is not a picture\n"},
        {"cut_header.png", "truncated", "ends within the header", png.substr(0, 20)},
        {"cut_pixels.png", "truncated", "ends within the pixels", cut(png, 0.6)},
        {"cut_end.png", "truncated", "has no mark of the end", png.substr(0, png.size() - 12)},
        {"wrong_sum.png", "malformed", "has a byte that its checksum does not agree with", flipped},
        {"lying_size.png",
         "truncated",
         "says 6000 x 6000 and has 4 rows",
         png_bytes(6000, 6000, {}, pattern_rows(3))},
        {"too_large.png",
         "over_limit",
         "says 100000 x 100000",
         png_bytes(100000, 100000, {}, pattern_rows(3))},
        {"no_pixels.png", "malformed", "is 0 pixels wide", png_bytes(0, 4, {}, "")},
        {"few_rows.png",
         "malformed",
         "has fewer rows than it says",
         png_bytes(kPatternWidth, kPatternHeight + 1, {}, pattern_rows(3))},
        {"depth_of_three.png",
         "malformed",
         "has three bits a channel",
         png_bytes(kPatternWidth, kPatternHeight, {3, 0, 0}, pattern_rows(1))},
        {"no_palette.png",
         "malformed",
         "has palette numbers and no palette",
         png_bytes(kPatternWidth, kPatternHeight, {8, 3, 0}, pattern_rows(1))},
        {"animated.png",
         "unsupported",
         "is animated",
         png_bytes(kPatternWidth, kPatternHeight, {}, pattern_rows(3), animation)},
        {"animated.gif", "unsupported", "is an animated GIF", gif},
        {"windows.bmp", "unsupported", "is a BMP", "BM" + std::string(60, '\0')},
        {"modern.webp", "unsupported", "is a WebP", std::string("RIFF\x10\0\0\0WEBPVP8 ", 16)},
        {"cut.jpg", "truncated", "ends within the scan", cut(jpeg, 0.9)},
        {"cut_tables.jpg", "truncated", "ends within the tables", cut(jpeg, 0.2)},
        {"lying_size.jpg",
         "truncated",
         "says 60000 x 1000 and has 5 x 4",
         with_word(jpeg, frame + 5, big(1000, 2) + big(60000, 2))},
        {"too_large.jpg", "over_limit", "says 65535 x 65535", with_word(jpeg, frame + 5, big(0xffffffffu))},
        {"twelve_bits.jpg", "unsupported", "has 12 bits a channel", with_word(jpeg, frame + 4, "\x0c")},
        {"arithmetic.jpg", "unsupported", "is arithmetic", with_word(jpeg, frame, "\xff\xc9")},
        {"no_scan.jpg", "malformed", "has no picture", std::string("\xff\xd8\xff\xe0\0\x02\xff\xd9", 8)},
        {"lying_size.hdr", "truncated", "is a header of 5000 x 5000", kHdrHead + "-Y 5000 +X 5000\n"},
        {"too_large.hdr", "over_limit", "is a header of 12000 x 12000", kHdrHead + "-Y 12000 +X 12000\n"},
        {"cut.hdr", "truncated", "ends within a row", cut(hdr, 0.8)},
        {"run_too_long.hdr",
         "malformed",
         "has a run that passes its row",
         kHdrHead + "-Y 1 +X 3\n" + std::string("\x80\x40\x20\x81\x01\x01\x01\x09", 8)},
        {"run_of_nothing.hdr",
         "malformed",
         "begins with a run",
         kHdrHead + "-Y 1 +X 3\n" + std::string("\x01\x01\x01\x03", 4)},
        {"sideways.hdr", "unsupported", "goes by columns", kHdrHead + "+X 2 -Y 2\n" + std::string(16, 'x')},
        {"xyze.hdr",
         "unsupported",
         "has XYZ",
         "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 2 +X 2\n" + std::string(16, 'x')},
        {"cut.tga", "truncated", "ends within the pixels", cut(pattern_tga(3, false), 0.8)},
        {"cut_runs.tga", "truncated", "ends within a run", cut(pattern_tga(3, true), 0.8)},
        {"lying_size.tga",
         "truncated",
         "says 5000 x 5000",
         with_word(pattern_tga(3, false), 12, std::string("\x88\x13\x88\x13", 4))},
        {"palette_too_short.tga", "index_out_of_range", "names a colour that is not there", palette_tga(3)},
    };
}

} // namespace

std::string png_chunk(std::string_view name, std::string_view content)
{
    const std::string body = std::string(name) + std::string(content);
    return big(static_cast<std::uint32_t>(content.size())) + body + big(crc_of(body));
}

std::string png_bytes(std::uint32_t width,
                      std::uint32_t height,
                      const PngForm& form,
                      std::string_view rows,
                      std::string_view chunks)
{
    return kMark + header(width, height, form) + std::string(chunks) + png_chunk("IDAT", stored(rows)) +
           png_chunk("IEND", "");
}

void write_images(const std::filesystem::path& folder)
{
    std::filesystem::create_directories(folder / "broken");
    write_file(folder / "grey.png", pattern_png(8, 0, 1));
    write_file(folder / "rgb.png", pattern_png(8, 2, 3));
    write_file(folder / "grey_alpha.png", pattern_png(8, 4, 2));
    write_file(folder / "rgba.png", pattern_png(8, 6, 4));
    write_file(folder / "grey_16.png", pattern_png(16, 0, 1));
    write_file(folder / "rgb_16.png", pattern_png(16, 2, 3));
    write_file(folder / "rgba_16.png", pattern_png(16, 6, 4));
    write_file(folder / "palette.png", palette_png(false));
    write_file(folder / "palette_alpha.png", palette_png(true));
    write_file(folder / "interlaced.png", interlaced_png());
    // 1 bit: 101, 010.
    write_file(folder / "bits.png", png_bytes(3, 2, {1, 0, 0}, std::string("\0\xa0\0\x40", 4)));
    write_file(folder / "rgb.jpg", pattern_jpeg());
    write_file(folder / "grey.jpg", grey_jpeg());
    write_file(folder / "light.hdr", light_hdr());
    write_file(folder / "flat.hdr", flat_hdr());
    write_file(folder / "old_runs.hdr", old_runs_hdr());
    write_file(folder / "rgb.tga", pattern_tga(3, false));
    write_file(folder / "rgba_runs.tga", pattern_tga(4, true));
    write_file(folder / "palette.tga", palette_tga(2));
    std::string manifest;
    for (const BrokenFile& file : broken_images()) {
        write_file(folder / "broken" / file.name, file.bytes);
        manifest += file.name + '\t' + file.codes + '\t' + file.what + '\n';
    }
    write_file(folder / "broken" / "manifest.tsv", manifest);
}

} // namespace tests
