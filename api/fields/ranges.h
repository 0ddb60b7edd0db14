// Ranges of the contract's numbers: checked by the reader, written into the schema, told in faults.
#pragma once

#include <cstdint>
#include <limits>

namespace api {

struct Range {
    double min = 0;
    double max = 0;
    bool without_min = false; // the end itself is not allowed
    bool without_max = false;

    [[nodiscard]] constexpr bool contains(double x) const
    {
        return (without_min ? x > min : x >= min) && (without_max ? x < max : x <= max);
    }
};

// `limit` names the service's limit that stands for `max`.
struct WholeRange {
    std::uint64_t min = 0;
    std::uint64_t max = std::numeric_limits<std::uint64_t>::max();
    const char* limit = nullptr;
};

// Farther than any scene; its square still is a float.
inline constexpr Range kCoordinate{-1e18, 1e18};
inline constexpr Range kSize{0, 1e18, true};
inline constexpr Range kReflectance{0, 1};
// Radiance, intensity, irradiance: sums of very many samples stay floats.
inline constexpr Range kRadiometric{0, 1e30};
inline constexpr Range kShininess{0, 1e6};
inline constexpr Range kShare{0, 1};
inline constexpr Range kIor{1e-3, 1e3};
inline constexpr Range kExtinction{0, 1e3};
inline constexpr Range kAbsorption{0, 1e9}; // 1/m: black within a nanometre
inline constexpr Range kFieldOfView{0, 180, true, true};
inline constexpr Range kInnerAngle{0, 180};
inline constexpr Range kOuterAngle{0, 180, true};
inline constexpr Range kLensRadius{0, 1e18};
inline constexpr Range kSunRadius{1e-7, 180}; // to the whole sky
inline constexpr Range kElevation{-90, 90};
inline constexpr Range kClamp{0, 1e30, true};
inline constexpr Range kTurn{-1e6, 1e6};
inline constexpr Range kExposure{-100, 100};
inline constexpr Range kSeconds{0, 1e7, true};

inline constexpr WholeRange kPriority{0, 100};
inline constexpr WholeRange kGlassPriority{0, 1000};
inline constexpr WholeRange kSeed{0, (std::uint64_t(1) << 53) - 1}; // what every JSON reader keeps exactly
inline constexpr WholeRange kDepth{0, 1'000'000};
inline constexpr WholeRange kThreads{0, 1024};
inline constexpr WholeRange kTile{1, 4096};
inline constexpr WholeRange kSamples{1, std::numeric_limits<std::uint32_t>::max(), "samples"};
inline constexpr WholeRange kSide{1, std::numeric_limits<std::uint32_t>::max(), "image_side_px"};
inline constexpr WholeRange kOffset{0, std::numeric_limits<std::uint32_t>::max()};
inline constexpr WholeRange kExtent{1, std::numeric_limits<std::uint32_t>::max()};

// Of names and values that are the client's own.
inline constexpr std::size_t kLongestName = 255;
inline constexpr std::size_t kLongestLabel = 255;
inline constexpr std::size_t kMostLabels = 64;

} // namespace api
