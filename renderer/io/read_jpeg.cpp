#include "renderer/io/image_bounds.h"
#include "renderer/io/read_images.h"
#include "renderer/io/text.h"

#include <cstring>
#include <memory>

// A copy of our own: only this format's code is compiled at all.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_FAILURE_STRINGS
#define STBI_MAX_DIMENSIONS (1 << 24)
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace renderer {

namespace {

// A progressive file may go over all its pixels in every scan.
constexpr std::size_t kMostScans = 64;

// Flat blocks of 64 pixels of three components take a few bits each.
constexpr std::uint64_t kMostPixelsPerByte = 1024;

constexpr std::uint32_t kFirstFrame = 0xc0, kProgressive = 0xc2, kHuffman = 0xc4, kReserved = 0xc8,
                        kArithmetic = 0xcc, kLastFrame = 0xcf, kFirstRestart = 0xd0, kLastRestart = 0xd7,
                        kEnd = 0xd9, kScan = 0xda, kAlone = 0x01;

class Walk {
public:
    Walk(std::span<const std::byte> bytes, const Limits& limits) : bytes_(bytes), limits_(limits) {}

    std::optional<ImportFault> run()
    {
        at_ = 2;
        while (true) {
            const std::optional<std::uint32_t> marker = next_marker();
            if (!marker) return ends_early();
            if (*marker == kEnd) break;
            if (*marker == kAlone || is_restart(*marker)) continue;
            if (auto bad = segment(*marker)) return bad;
        }
        if (!has_frame_ || scans_ == 0)
            return ImportFault{"malformed", "the JPEG ends before it has a picture"};
        return std::nullopt;
    }

private:
    static bool is_restart(std::uint32_t marker) { return marker >= kFirstRestart && marker <= kLastRestart; }
    static ImportFault ends_early()
    {
        return {"truncated", "the JPEG ends without its mark of the end: send the file whole"};
    }
    std::uint32_t byte(std::size_t at) const { return std::to_integer<std::uint32_t>(bytes_[at]); }
    std::uint32_t pair(std::size_t at) const { return byte(at) << 8 | byte(at + 1); }

    // Skips what a scan holds, and fill bytes.
    std::optional<std::uint32_t> next_marker()
    {
        while (at_ + 1 < bytes_.size()) {
            if (byte(at_) != 0xff) {
                ++at_;
                continue;
            }
            const std::uint32_t second = byte(at_ + 1);
            if (second == 0xff) {
                ++at_;
                continue;
            }
            at_ += 2;
            if (second != 0) return second;
        }
        return std::nullopt;
    }

    std::optional<ImportFault> segment(std::uint32_t marker)
    {
        if (bytes_.size() - at_ < 2) return ends_early();
        const std::size_t length = pair(at_);
        if (length < 2 || length > bytes_.size() - at_) return ends_early();
        const bool is_frame = marker >= kFirstFrame && marker <= kLastFrame && marker != kHuffman &&
                              marker != kReserved && marker != kArithmetic;
        if (is_frame)
            if (auto bad = frame(marker, length)) return bad;
        if (marker == kHuffman)
            if (auto bad = huffman_tables(length)) return bad;
        if (marker == kScan && ++scans_ > kMostScans)
            return ImportFault{"over_limit",
                               "the JPEG has more than " + std::to_string(kMostScans) +
                                   " scans: save it as a baseline JPEG"};
        at_ += length;
        return std::nullopt;
    }

    // stb has room for 256 codes a table and writes as many as a file says.
    std::optional<ImportFault> huffman_tables(std::size_t length) const
    {
        constexpr std::size_t kHead = 17, kMostCodes = 256; // which table, and how many codes of each length
        for (std::size_t at = at_ + 2, end = at_ + length; at < end;) {
            std::size_t codes = 0;
            for (std::size_t i = 1; i < kHead && at + i < end; ++i)
                codes += byte(at + i);
            if (end - at < kHead || codes > kMostCodes || codes > end - at - kHead)
                return ImportFault{"malformed",
                                   "byte " + std::to_string(at) +
                                       ": the JPEG has a Huffman table of more codes than there are"};
            at += kHead + codes;
        }
        return std::nullopt;
    }

    std::optional<ImportFault> frame(std::uint32_t marker, std::size_t length)
    {
        if (marker > kProgressive)
            return ImportFault{"unsupported",
                               "the JPEG is lossless, hierarchical or arithmetic: save it as a baseline or "
                               "progressive JPEG"};
        if (has_frame_ || length < 8)
            return ImportFault{"malformed",
                               "byte " + std::to_string(at_) + ": the JPEG's frame is not one frame"};
        has_frame_ = true;
        if (byte(at_ + 2) != 8)
            return ImportFault{"unsupported",
                               "the JPEG has " + std::to_string(byte(at_ + 2)) +
                                   " bits a channel; 8 are read"};
        return over_image_bounds(
            "JPEG", pair(at_ + 5), pair(at_ + 3), bytes_.size() * kMostPixelsPerByte, limits_);
    }

    std::span<const std::byte> bytes_;
    const Limits& limits_;
    std::size_t at_ = 0;
    bool has_frame_ = false;
    std::size_t scans_ = 0;
};

struct FreePixels {
    void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
};

} // namespace

ImageResult read_jpeg(std::span<const std::byte> bytes, const Limits& limits)
{
    if (auto bad = Walk(bytes, limits).run()) return std::move(*bad);
    if (bytes.size() > 0x7fffffffu) return ImportFault{"over_limit", "a JPEG of more than 2 GiB is not read"};
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, FreePixels> pixels(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()),
                              static_cast<int>(bytes.size()),
                              &width,
                              &height,
                              &channels,
                              0));
    if (!pixels || width <= 0 || height <= 0 || (channels != 1 && channels != 3))
        return ImportFault{"malformed", "the JPEG cannot be decoded: save it again"};
    Image image = empty_image(static_cast<std::uint32_t>(width),
                              static_cast<std::uint32_t>(height),
                              static_cast<std::uint32_t>(channels),
                              PixelType::whole_8);
    std::memcpy(image.bytes.data(), pixels.get(), image.bytes.size());
    return ImportedImage{std::move(image), "jpeg"};
}

} // namespace renderer
