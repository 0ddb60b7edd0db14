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

// Parts of one object that have materials of their own are bodies apart.
struct BodyId {
    std::uint32_t instance = 0xffffffff, material = 0xffffffff;
    friend constexpr bool operator==(BodyId, BodyId) = default;
    friend constexpr bool operator<(BodyId a, BodyId b)
    {
        return a.instance != b.instance ? a.instance < b.instance : a.material < b.material;
    }
};

class Media {
public:
    static constexpr std::size_t kMost = 8;

    struct Boundary {
        bool is_real = true; // else light passes unbent
        float eta = 1;       // index behind it over index on the viewer's side
    };
    // A boundary of a body met from outside or inside: nothing changes yet.
    Boundary boundary(BodyId body, const GlassMedium& medium, bool from_outside) const;
    // Light has passed it.
    void cross(BodyId body, const GlassMedium& medium, bool from_outside);

    // What fills the place where the path is; nothing: vacuum.
    const GlassMedium* here() const { return top(BodyId{}); }

private:
    struct Body {
        BodyId id{};
        GlassMedium medium{};
    };
    const GlassMedium* top(BodyId but) const; // but for one body

    std::array<Body, kMost> bodies_{}; // in the order they were entered
    std::size_t count_ = 0;
};

} // namespace renderer
