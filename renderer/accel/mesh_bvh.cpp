#include "renderer/accel/mesh_bvh.h"

#include "renderer/accel/traverse.h"
#include "renderer/geometry/triangle.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace renderer {

namespace {

constexpr float kUnit = 0x1p-24f; // relative rounding of float

// The power of two with the exponent of `x`, inverted: x * inverse_power(x) is in [1, 4).
double inverse_power(double x)
{
    const std::uint64_t exponent = (std::bit_cast<std::uint64_t>(x) >> 52) & 0x7ff;
    return std::bit_cast<double>(std::max<std::uint64_t>(1, 2046 - std::min<std::uint64_t>(exponent, 2046))
                                 << 52);
}

// A float no less than x.
float narrow_up(double x)
{
    return static_cast<float>(x) + std::abs(static_cast<float>(x)) * (2 * kUnit) +
           std::numeric_limits<float>::min();
}

float largest(const Bounds3f& box)
{
    return std::max(max_abs(box.lower), max_abs(box.upper));
}

// Coordinates far from 1 are scaled by a power of two, so that products of them stay within float's range.
float kernel_scale(const Bounds3f& box)
{
    const float size = largest(box);
    if (!(size > 0) || (size > 0x1p-40f && size < 0x1p40f)) return 1;
    int exponent = 0;
    std::frexp(size, &exponent);
    return std::ldexp(1.0f, std::clamp(-exponent, -126, 126));
}

} // namespace

// The ray as the kernels see it: in scaled coordinates, its direction brought to a length near 1 by a power
// of two, so that t counts in units of its own.
struct MeshBvh::KernelRay {
    WatertightRay<double> exact;
    Vec3d direction;
    double t_min = 0, t_max = 0; // kernel units
    double ray_units = 1;        // t of the ray = t of the kernel * ray_units
    // The float copy starts at `start` (kernel units), where the double ray enters the mesh's bounds.
    double start = 0;
    Vec3f origin;
    float sx = 0, sy = 0;
    float lateral = 0; // how far to the side of the double ray anything computed from the float copy may be
    SlabRay<float> slabs;

    // The double part. False: the ray is not traceable.
    bool prepare_exact(const Ray& ray, float scale);
    // Both parts. False: the ray also may miss the box.
    bool prepare(const Ray& ray, const Bounds3f& box, float scale);
    // Where boxes may be left out, once a hit at t (kernel units) is known.
    float end_for(double t) const { return narrow_up(t - start) + 4 * lateral; }
    // False: the double test would miss this triangle for certain, whatever t.
    bool may_hit(Vec3f a, Vec3f b, Vec3f c) const;
};

bool MeshBvh::KernelRay::prepare_exact(const Ray& ray, float scale)
{
    if (!is_traceable(ray)) return false;
    const double direction_scale = inverse_power(max_abs(ray.direction));
    direction = ray.direction * direction_scale;
    exact = WatertightRay<double>(ray.origin * static_cast<double>(scale), direction);
    const double units = static_cast<double>(scale) / direction_scale;
    t_min = ray.t_min * units;
    t_max = ray.t_max * units;
    ray_units = direction_scale / static_cast<double>(scale);
    return true;
}

bool MeshBvh::KernelRay::prepare(const Ray& ray, const Bounds3f& box, float scale)
{
    if (!prepare_exact(ray, scale)) return false;
    // Where double itself may be off: origin, box and the test's own roundings.
    const double blur = 0x1p-49 * (max_abs(exact.origin) + static_cast<double>(largest(box)));
    const Vec3d inverse = reciprocal(direction);
    double exit = 0;
    const SlabRay<double> whole(exact.origin, inverse, blur);
    if (!whole.meets(to_double(box.lower), to_double(box.upper), t_min, t_max, start, exit)) return false;
    sx = static_cast<float>(exact.sx);
    sy = static_cast<float>(exact.sy);
    origin = to_float(exact.origin + direction * start);
    const float reach = std::max(max_abs(box.lower - origin), max_abs(box.upper - origin));
    lateral = kUnit * (8 * reach + 4 * max_abs(origin)) + 2 * static_cast<float>(blur);
    slabs = SlabRay<float>(origin, to_float(inverse), lateral);
    return true;
}

// The corners' places across the ray are within `lateral` of where the double test has them, so an edge value
// is within `slack` of its counterpart; only when two edges disagree beyond that is the triangle certainly
// missed. A NaN disagrees with nothing.
bool MeshBvh::KernelRay::may_hit(Vec3f a, Vec3f b, Vec3f c) const
{
    struct Corner {
        float x, y;
    };
    const auto shear = [&](Vec3f v) {
        const Vec3f p = v - origin;
        const float depth = p[exact.kz];
        return Corner{p[exact.kx] - sx * depth, p[exact.ky] - sy * depth};
    };
    const Corner pa = shear(a), pb = shear(b), pc = shear(c);
    const float e0 = pc.x * pb.y - pc.y * pb.x, e1 = pa.x * pc.y - pa.y * pc.x,
                e2 = pb.x * pa.y - pb.y * pa.x;
    const auto size = [](Corner p) { return std::abs(p.x) + std::abs(p.y); };
    const float widest = std::max(std::max(size(pa), size(pb)), size(pc));
    const float slack = 4 * lateral * (widest + lateral);
    const float least = std::min(std::min(e0, e1), e2), most = std::max(std::max(e0, e1), e2);
    return !(least < -slack && most > slack);
}

std::optional<MeshBvh>
MeshBvh::build(const Mesh& mesh, TriangleRun run, BvhSplit split, ThreadPool& pool, std::stop_token stop)
{
    MeshBvh built;
    std::vector<std::uint32_t> kept;
    kept.reserve(run.count);
    for (std::uint32_t i = run.first; i < run.first + run.count; ++i) {
        const Triangle& v = mesh.triangles[i];
        if (is_degenerate(mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]])) {
            ++built.degenerate_;
            continue;
        }
        for (const std::uint32_t vertex : v)
            built.bounds_.extend(mesh.positions[vertex]);
        kept.push_back(i);
    }
    if (kept.empty()) return built;
    built.scale_ = kernel_scale(built.bounds_);
    const auto corner = [&](std::uint32_t triangle, std::size_t k) {
        return mesh.positions[mesh.triangles[triangle][k]] * built.scale_;
    };
    std::vector<Bounds3f> boxes(kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            boxes[i].extend(corner(kept[i], k));
    std::optional<Bvh<float>> bvh = build_bvh<float>(boxes, {.split = split}, pool, stop);
    if (!bvh) return std::nullopt;
    built.bvh_ = std::move(*bvh);
    built.leaves_.resize(kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const std::uint32_t triangle = kept[built.bvh_.order[i]];
        built.leaves_[i] = {corner(triangle, 0), corner(triangle, 1), corner(triangle, 2), triangle};
    }
    built.bvh_.order = {}; // the leaves are in its order
    return built;
}

// The double test of one triangle, drawn in to the best hit so far. True where it became the best.
bool MeshBvh::test(const KernelRay& ray, const LeafTriangle& triangle, std::optional<MeshHit>& best)
{
    const auto hit = intersect_watertight(
        ray.exact, ray.t_min, ray.t_max, to_double(triangle.a), to_double(triangle.b), to_double(triangle.c));
    if (!hit) return false;
    if (best && (hit->t > best->t || (hit->t == best->t && triangle.primitive > best->primitive)))
        return false;
    best = {hit->t, triangle.primitive, hit->barycentrics};
    return true;
}

template <bool kAnyHit>
std::optional<MeshHit> MeshBvh::trace(const Ray& ray) const
{
    std::optional<MeshHit> best;
    KernelRay kernel;
    if (leaves_.empty() || !kernel.prepare(ray, {bvh_.root.lower, bvh_.root.upper}, scale_)) return best;
    const auto leaf = [&](std::uint32_t first, std::uint32_t count, float& end) {
        for (std::uint32_t i = first; i < first + count; ++i) {
            const LeafTriangle& triangle = leaves_[i];
            if (!kernel.may_hit(triangle.a, triangle.b, triangle.c) || !test(kernel, triangle, best))
                continue;
            if (kAnyHit) return true;
            end = std::min(end, kernel.end_for(best->t));
        }
        return false;
    };
    traverse(bvh_, kernel.slabs, -4 * kernel.lateral, kernel.end_for(kernel.t_max), leaf);
    if (best) best->t *= kernel.ray_units;
    return best;
}

std::optional<MeshHit> MeshBvh::closest_hit(const Ray& ray) const
{
    return trace<false>(ray);
}

bool MeshBvh::any_hit(const Ray& ray) const
{
    return trace<true>(ray).has_value();
}

// Every triangle, by the double test alone.
std::optional<MeshHit> MeshBvh::closest_hit_brute_force(const Ray& ray) const
{
    std::optional<MeshHit> best;
    KernelRay kernel;
    if (!kernel.prepare_exact(ray, scale_)) return best;
    for (const LeafTriangle& triangle : leaves_)
        test(kernel, triangle, best);
    if (best) best->t *= kernel.ray_units;
    return best;
}

bool MeshBvh::any_hit_brute_force(const Ray& ray) const
{
    return closest_hit_brute_force(ray).has_value();
}

std::uint64_t MeshBvh::node_bytes() const
{
    return bvh_.size_bytes();
}

std::uint64_t MeshBvh::size_bytes() const
{
    return node_bytes() + leaves_.capacity() * sizeof(LeafTriangle);
}

} // namespace renderer
