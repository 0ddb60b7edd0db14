// TransportDescription: which paths of light are followed, and how far.
#pragma once

#include <cstdint>

namespace renderer {

enum class TransportType : std::uint8_t { automatic, direct };

struct TransportDescription {
    TransportType type = TransportType::automatic;
    friend bool operator==(const TransportDescription&, const TransportDescription&) = default;
};

} // namespace renderer
