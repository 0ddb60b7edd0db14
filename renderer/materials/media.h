// Media: what bodies of glass a path is inside of, so that each boundary knows what is on either side of it.
//
// Bodies may overlap: the one of the highest priority fills the place, of several the one that was entered last.
// A boundary within a body that outranks it is no boundary: light passes it unbent.
//
// Source  C. Schmidt, B. Budge, "Simple Nested Dielectrics in Ray Traced Images", JGT 7(2), 2002.
// Limits  kMost bodies at once: one more is not entered, which its inside shows.
#pragma once

#include "renderer/materials/bsdf.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace renderer {

class Media {
public:
    static constexpr std::size_t kMost = 8;

    struct Boundary {
        bool is_real = true; // else light passes unbent
        float eta = 1;       // index behind it over index on the viewer's side
    };
    // A boundary of body `instance` met from outside or inside: nothing changes yet.
    Boundary boundary(std::uint32_t instance, const GlassMedium& medium, bool from_outside) const;
    // Light has passed it.
    void cross(std::uint32_t instance, const GlassMedium& medium, bool from_outside);

    // What fills the place where the path is; nothing: vacuum.
    const GlassMedium* here() const { return top(kNobody); }

private:
    static constexpr std::uint32_t kNobody = 0xffffffff;
    struct Body {
        std::uint32_t instance = kNobody;
        GlassMedium medium{};
    };
    const GlassMedium* top(std::uint32_t but) const; // but for one body

    std::array<Body, kMost> bodies_{}; // in the order they were entered
    std::size_t count_ = 0;
};

} // namespace renderer
