// TransportDescription: which paths of light are followed, and how far.
#pragma once

#include <cstdint>
#include <optional>

namespace renderer {

enum class TransportType : std::uint8_t { automatic, direct, whitted, path, ambient_occlusion, normals };

struct TransportDescription {
    TransportType type = TransportType::automatic;
    // Scatterings at surfaces from light to eye: 0 emission only, 1 direct light. Nothing: 4 for whitted, no bound
    // for path.
    std::optional<std::uint32_t> max_depth;
    // Most that any one path but the straight ones adds to a channel; what is cut off is lost. Nothing: no bound.
    std::optional<double> clamp;
    friend bool operator==(const TransportDescription&, const TransportDescription&) = default;
};
inline constexpr std::uint32_t kWhittedDepth = 4; // the three recursions of the classic algorithm

} // namespace renderer
