#include "renderer/accel/spatial_split.h"

#include "renderer/accel/triangle_part.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace renderer {

namespace {

constexpr std::size_t kSlices = 16;

using Lanes = Lanes4<float>;

struct LanesBox {
    Lanes lower = Lanes::splat(std::numeric_limits<float>::infinity());
    Lanes upper = Lanes::splat(-std::numeric_limits<float>::infinity());

    void extend(Lanes point)
    {
        lower = min(point, lower);
        upper = max(point, upper);
    }
    void extend(const LanesBox& box)
    {
        lower = min(box.lower, lower);
        upper = max(box.upper, upper);
    }
    double half_area() const
    {
        alignas(16) float l[4], u[4];
        lower.store(l);
        upper.store(u);
        const Bounds3f box{{l[0], l[1], l[2]}, {u[0], u[1], u[2]}};
        return box.empty()
                   ? 0
                   : renderer::half_area(box); // empty: what is counted there is no more of its triangle
    }
};

// A run in slices of equal width along one axis, to tell what planes cost: boxes as float sees them.
class Slices {
public:
    LanesBox boxes[kSlices];
    std::size_t entering[kSlices]{}, leaving[kSlices]{}; // items whose box begins, or ends, there
    float planes[kSlices + 1];

    Slices(const Bounds3f& box, unsigned axis) : axis_(axis), lower_(box.lower[axis])
    {
        const float width = (box.upper[axis] - lower_) / kSlices;
        per_width_ = 1 / width;
        is_usable_ = width > 0 && std::isfinite(width) && std::isfinite(per_width_);
        for (std::size_t i = 0; i < kSlices; ++i)
            planes[i] = lower_ + width * static_cast<float>(i);
        planes[kSlices] = box.upper[axis];
    }

    bool is_usable() const { return is_usable_; }

    void add(const TriangleItem& item, const TriangleParts& parts)
    {
        const std::size_t first = slice_at(item.lower[axis_]), last = slice_at(item.upper[axis_]);
        ++entering[first];
        ++leaving[last];
        const LanesBox whole{Lanes::load3(item.lower), Lanes::load3(item.upper)};
        if (first == last) return boxes[first].extend(whole);
        LanesBox own[kSlices]; // what the triangle has in slices first, first + 1, ...
        add_edges(parts.corners(item).at, first, last, own);
        for (std::size_t i = first; i <= last; ++i) {
            LanesBox& part = own[i - first];
            part.lower = max(part.lower, whole.lower);
            part.upper = min(part.upper, whole.upper);
            // Where earlier cuts left nothing of it.
            if ((less(part.upper, part.lower) & 7) == 0) boxes[i].extend(part);
        }
    }

private:
    std::size_t slice_at(float x) const
    {
        const float at = std::min(std::max((x - lower_) * per_width_, 0.0f), static_cast<float>(kSlices - 1));
        return static_cast<std::size_t>(at);
    }

    void add_edges(const Vec3f (&corners)[3], std::size_t first, std::size_t last, LanesBox* own) const
    {
        const auto lanes_of = [](const Vec3f& p) {
            alignas(16) const float padded[4] = {p.x, p.y, p.z, 0};
            return Lanes::load(padded);
        };
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f *a = &corners[k], *b = &corners[k == 2 ? 0 : k + 1];
            if ((*b)[axis_] < (*a)[axis_]) std::swap(a, b);
            const float from = (*a)[axis_], to = (*b)[axis_];
            const std::size_t begin = slice_at(from), end = slice_at(to);
            const Lanes at_begin = lanes_of(*a), at_end = lanes_of(*b);
            if (first <= begin && begin <= last) own[begin - first].extend(at_begin);
            if (first <= end && end <= last) own[end - first].extend(at_end);
            if (begin == end) continue;
            const Lanes way = at_end - at_begin;
            const float per_way = 1 / (to - from);
            for (std::size_t i = std::max(begin, first) + 1; i <= std::min(end, last); ++i) {
                const Lanes at = at_begin + way * Lanes::splat((planes[i] - from) * per_way);
                own[i - 1 - first].extend(at);
                own[i - first].extend(at);
            }
        }
    }

    unsigned axis_;
    float lower_, per_width_;
    bool is_usable_;
};

} // namespace

TriangleItem TriangleParts::part(const TriangleItem& item, unsigned axis, float from, float to) const
{
    const Triangle& v = mesh_.triangles[item.primitive];
    const Vec3d corners[3] = {
        mesh_.position(v[0]) * scale_, mesh_.position(v[1]) * scale_, mesh_.position(v[2]) * scale_};
    const Bounds3f box = part_between(corners, axis, from, to);
    TriangleItem part = item;
    part.lower[axis] = std::max(item.lower[axis], from);
    part.upper[axis] = std::min(item.upper[axis], to);
    if (box.empty()) return part; // the planes meet the box alone
    for (unsigned i = 0; i < 3; ++i) {
        const float lower = std::max(part.lower[i], box.lower[i]),
                    upper = std::min(part.upper[i], box.upper[i]);
        // What earlier cuts left of the triangle may not reach so far.
        if (lower > upper) continue;
        part.lower[i] = lower;
        part.upper[i] = upper;
    }
    return part;
}

std::optional<PlaneCut> best_plane(std::span<const TriangleItem> run,
                                   const RunBounds<float>& bounds,
                                   const TriangleParts& parts,
                                   std::uint32_t block,
                                   std::size_t most,
                                   double limit)
{
    const auto tests = [block](std::size_t items) {
        const std::size_t blocks = (items + block - 1) / block;
        return static_cast<double>(blocks);
    };
    std::optional<PlaneCut> best;
    for (unsigned axis = 0; axis < 3; ++axis) {
        Slices slices(bounds.box(), axis);
        if (!slices.is_usable()) continue;
        for (const TriangleItem& item : run)
            slices.add(item, parts);
        LanesBox right_box;
        double right_area[kSlices];
        std::size_t right[kSlices], count = 0;
        for (std::size_t i = kSlices; i-- > 1;) {
            right_box.extend(slices.boxes[i]);
            right_area[i] = right_box.half_area();
            right[i] = count += slices.leaving[i];
        }
        LanesBox left_box;
        std::size_t left = 0;
        for (std::size_t i = 1; i < kSlices; ++i) {
            left_box.extend(slices.boxes[i - 1]);
            left += slices.entering[i - 1];
            if (left == 0 || right[i] == 0 || left == run.size() || right[i] == run.size()) continue;
            if (left + right[i] > most) continue;
            const double cost = left_box.half_area() * tests(left) + right_area[i] * tests(right[i]);
            if (!(cost < limit)) continue;
            limit = cost;
            best = PlaneCut{axis, slices.planes[i]};
        }
    }
    return best;
}

bool cut_by_plane(ItemRun& run,
                  std::size_t begin,
                  const PlaneCut& cut,
                  const TriangleParts& parts,
                  std::size_t most,
                  Sides<float>& sides)
{
    const unsigned axis = cut.axis;
    const float plane = cut.plane;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const auto is_left = [&](const TriangleItem& item) { return item.upper[axis] <= plane; };
    const auto is_right = [&](const TriangleItem& item) { return plane <= item.lower[axis]; };
    const std::span<TriangleItem> whole = run.from(begin);
    std::size_t lefts = 0, rights = 0;
    for (const TriangleItem& item : whole) {
        lefts += is_left(item) || !is_right(item);
        rights += !is_left(item);
    }
    if (lefts == 0 || rights == 0 || lefts == whole.size() || rights == whole.size()) return false;
    if (lefts + rights > most) return false;
    sides = {};
    const std::size_t end = run.size();
    std::size_t next = begin;
    for (std::size_t i = begin; i < end; ++i) {
        TriangleItem item = run[i];
        if (!is_left(item)) {
            if (is_right(item)) continue;
            run.add(parts.part(item, axis, plane, kInfinity));
            item = parts.part(item, axis, -kInfinity, plane);
        }
        run[i] = run[next];
        run[next++] = item;
    }
    sides.left = next - begin;
    for (std::size_t i = begin; i < run.size(); ++i)
        sides.bounds[i < next ? 0 : 1].extend(run[i]);
    return true;
}

} // namespace renderer
