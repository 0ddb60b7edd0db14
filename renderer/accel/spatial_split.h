// Spatial splits: a run of triangles cut by a plane, what crosses it going to both sides, each by the box of its part
// there. Where long triangles lie among small ones no sorting of whole boxes keeps the two sides apart.
//
// Promise  pure functions of the run in its order.
// Source   M. Stich, H. Friedrich, A. Dietrich, "Spatial Splits in Bounding Volume Hierarchies", HPG 2009.
#pragma once

#include "renderer/accel/split.h"
#include "renderer/geometry/mesh.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace renderer {

using TriangleItem = BuildItem<float>;

// A run with room behind it for what cuts add: a view of places that somebody else keeps.
class ItemRun {
public:
    ItemRun() = default;
    explicit ItemRun(std::span<TriangleItem> places, std::size_t size = 0) : places_(places), size_(size) {}

    std::size_t size() const { return size_; }
    TriangleItem& operator[](std::size_t i) { return places_[i]; }
    std::span<TriangleItem> from(std::size_t begin) { return places_.first(size_).subspan(begin); }
    void add(const TriangleItem& item) { places_[size_++] = item; } // there is room
    void shorten(std::size_t size) { size_ = size; }
    std::span<TriangleItem> places() const { return places_; } // the room counted

private:
    std::span<TriangleItem> places_;
    std::size_t size_ = 0;
};

// The triangles that items stand for, in scaled coordinates.
class TriangleParts {
public:
    TriangleParts(const Mesh& mesh, float scale) : mesh_(mesh), scale_(static_cast<double>(scale)) {}

    // The item's box, narrowed to what of its triangle lies between two planes that meet it.
    TriangleItem part(const TriangleItem& item, unsigned axis, float from, float to) const;

    struct Corners {
        Vec3f at[3];
    };
    Corners corners(const TriangleItem& item) const // to a float
    {
        const Triangle& v = mesh_.triangles[item.primitive];
        const auto at = [&](std::uint32_t vertex) {
            return mesh_.positions[vertex] * static_cast<float>(scale_);
        };
        return {{at(v[0]), at(v[1]), at(v[2])}};
    }

private:
    const Mesh& mesh_;
    double scale_;
};

struct PlaneCut {
    unsigned axis;
    float plane;
};

// The cheapest plane of a few across each axis, if it costs less than `limit` (areas times tests, of both sides) and both
// sides hold no more than `most` together.
std::optional<PlaneCut> best_plane(std::span<const TriangleItem> run,
                                   const RunBounds<float>& bounds,
                                   const TriangleParts& parts,
                                   std::uint32_t block,
                                   std::size_t most,
                                   double limit);

// Cuts what `run` holds from `begin` on: the left side stays there, the right one follows it.
// Where a side would be empty or no smaller than the whole, or both hold more than `most`, for which there is room, nothing
// is done: false.
bool cut_by_plane(ItemRun& run,
                  std::size_t begin,
                  const PlaneCut& cut,
                  const TriangleParts& parts,
                  std::size_t most,
                  Sides<float>& sides);

} // namespace renderer
