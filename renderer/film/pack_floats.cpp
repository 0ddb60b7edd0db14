#include "renderer/film/pack_floats.h"

#include "renderer/film/append_bytes.h"

#include <array>
#include <bit>
#include <cstring>
#include <new>
#include <zlib.h>

namespace renderer {

namespace {

constexpr std::size_t kPlanes = 4;
constexpr std::size_t kSmall = 32768; // numbers that are not worth the while
constexpr std::size_t kHead = 1 + 8;  // of a plane: how it is kept, its bytes
constexpr int kLevel = 1;

enum class Kept : std::uint8_t { as_it_is, deflated };

// The sum of the squares of the bytes' shares: 1 where there is one value, 1/256 where all are as frequent. Below
// an eighth, deflating takes long for little.
bool is_worth_deflating(std::span<const std::uint8_t> plane)
{
    std::array<std::uint64_t, 256> counts{};
    for (const std::uint8_t byte : plane)
        ++counts[byte];
    double squares = 0;
    for (const std::uint64_t count : counts)
        squares += static_cast<double>(count) * static_cast<double>(count);
    return squares > static_cast<double>(plane.size()) * static_cast<double>(plane.size()) / 8;
}

void append_plane(Bytes& out, std::span<const std::uint8_t> plane, bool may_deflate)
{
    const std::size_t head = out.size();
    out.resize(head + kHead);
    Kept kept = Kept::as_it_is;
    if (may_deflate && is_worth_deflating(plane)) {
        uLongf size = compressBound(static_cast<uLong>(plane.size()));
        out.resize(head + kHead + size);
        if (compress2(
                out.data() + head + kHead, &size, plane.data(), static_cast<uLong>(plane.size()), kLevel) !=
            Z_OK)
            throw std::bad_alloc(); // there is room for the worst
        kept = size < plane.size() ? Kept::deflated : Kept::as_it_is;
        out.resize(head + kHead + (kept == Kept::deflated ? size : 0));
    }
    if (kept == Kept::as_it_is) out.insert(out.end(), plane.begin(), plane.end());
    out[head] = static_cast<std::uint8_t>(kept);
    const std::uint64_t size = out.size() - head - kHead;
    for (std::size_t i = 0; i < 8; ++i)
        out[head + 1 + i] = static_cast<std::uint8_t>(size >> (8 * i));
}

// Takes one plane off the front.
bool take_plane(std::span<const std::uint8_t>& bytes, std::span<std::uint8_t> plane)
{
    if (bytes.size() < kHead || bytes[0] > static_cast<std::uint8_t>(Kept::deflated)) return false;
    const auto kept = static_cast<Kept>(bytes[0]);
    std::uint64_t size = 0;
    for (std::size_t i = 0; i < 8; ++i)
        size |= std::uint64_t{bytes[1 + i]} << (8 * i);
    bytes = bytes.subspan(kHead);
    if (size > bytes.size()) return false;
    const auto packed = bytes.first(static_cast<std::size_t>(size));
    bytes = bytes.subspan(packed.size());
    switch (kept) {
    case Kept::as_it_is:
        if (packed.size() != plane.size()) return false;
        std::memcpy(plane.data(), packed.data(), packed.size());
        return true;
    case Kept::deflated: {
        uLongf room = static_cast<uLongf>(plane.size());
        return uncompress(plane.data(), &room, packed.data(), static_cast<uLong>(packed.size())) == Z_OK &&
               room == plane.size();
    }
    }
    return false;
}

constexpr unsigned shift_of(std::size_t plane)
{
    return static_cast<unsigned>(8 * (kPlanes - 1 - plane));
}

} // namespace

std::vector<std::uint8_t> pack_floats(std::span<const float> values)
{
    Bytes out;
    if (values.empty()) return out;
    out.reserve(values.size_bytes() + kPlanes * kHead);
    Bytes plane(values.size());
    for (std::size_t p = 0; p < kPlanes; ++p) {
        for (std::size_t i = 0; i < values.size(); ++i)
            plane[i] = static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(values[i]) >> shift_of(p));
        append_plane(out, plane, values.size() > kSmall);
    }
    return out;
}

bool unpack_floats(std::span<const std::uint8_t> bytes, std::span<float> values)
{
    if (values.empty()) return bytes.empty();
    std::vector<std::uint32_t> bits(values.size());
    Bytes plane(values.size());
    for (std::size_t p = 0; p < kPlanes; ++p) {
        if (!take_plane(bytes, plane)) return false;
        for (std::size_t i = 0; i < values.size(); ++i)
            bits[i] |= std::uint32_t{plane[i]} << shift_of(p);
    }
    if (!bytes.empty()) return false;
    std::memcpy(values.data(), bits.data(), values.size_bytes());
    return true;
}

} // namespace renderer
