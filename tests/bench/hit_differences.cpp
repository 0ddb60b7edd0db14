#include "tests/bench/hit_differences.h"

#include "renderer/geometry/triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bench {

using namespace renderer;

namespace {

enum class Why { edge, end, accepted, neither };

struct Corners {
    Vec3d a, b, c;
};

Corners corners_of(const Mesh& mesh, std::uint32_t triangle)
{
    const Triangle& v = mesh.triangles[triangle];
    return {
        to_double(mesh.positions[v[0]]), to_double(mesh.positions[v[1]]), to_double(mesh.positions[v[2]])};
}

// From the ray to the segment pq, both seen along the ray's main axis.
double distance_to_edge(const watertight::Corner<double>& p, const watertight::Corner<double>& q)
{
    const double ex = q.x - p.x, ey = q.y - p.y, squared = ex * ex + ey * ey;
    const double along = squared > 0 ? std::clamp(-(p.x * ex + p.y * ey) / squared, 0.0, 1.0) : 0;
    return std::hypot(p.x + along * ex, p.y + along * ey);
}

// What float arithmetic may get wrong about this ray and triangle; or that there is nothing to get wrong.
Why look_closely(const Mesh& mesh, const FloatRay& float_ray, std::uint32_t triangle)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const Corners v = corners_of(mesh, triangle);
    const Ray ray{to_double(float_ray.origin), to_double(float_ray.direction), -kInfinity, kInfinity};
    const WatertightRay<double> sheared(ray.origin, ray.direction);
    const auto pa = watertight::shear(sheared, v.a), pb = watertight::shear(sheared, v.b),
               pc = watertight::shear(sheared, v.c);
    const double size = std::max(
        max_component(abs(ray.origin)),
        std::max(std::max(max_component(abs(v.a)), max_component(abs(v.b))), max_component(abs(v.c))));
    const double rounding = HitDifferences::kRoundings * 0x1p-24 * size;
    const double to_edge =
        std::min(std::min(distance_to_edge(pa, pb), distance_to_edge(pb, pc)), distance_to_edge(pc, pa));
    const auto anywhere = intersect_watertight(ray, v.a, v.b, v.c);
    if (anywhere) {
        // A grazing ray meets the plane anywhere within a rounding over the sine of its angle.
        const Vec3d n = normalize(cross(v.b - v.a, v.c - v.a));
        const double speed = length(ray.direction);
        const double sine = std::max(std::abs(dot(n, ray.direction)) / speed, 1e-12);
        const double t_rounding = rounding / sine / speed;
        const double t_min = float_ray.t_min, t_max = float_ray.t_max;
        if (std::abs(anywhere->t - t_min) <= t_rounding || std::abs(anywhere->t - t_max) <= t_rounding)
            return Why::end;
        if (to_edge <= rounding) return Why::edge;
        return anywhere->t > t_min && anywhere->t < t_max ? Why::accepted : Why::neither;
    }
    return to_edge <= rounding ? Why::edge : Why::neither;
}

FoundHit closest(const RayEngine& engine, const FloatRay& ray)
{
    const RaySet one{"", false, false, {}};
    FoundHit found;
    engine.trace(one, {&ray, 1}, &found);
    return found;
}

// A triangle that only one side has found, and the other rejects or passes over.
void explain(HitDifferences& out, const Mesh& mesh, const FloatRay& ray, std::uint32_t triangle, bool ours)
{
    if (triangle == FoundHit::kMiss) { // found as any hit, not as the closest one
        ++out.unexplained;
        return;
    }
    switch (look_closely(mesh, ray, triangle)) {
    case Why::edge:
        ++out.at_edge;
        return;
    case Why::end:
        ++out.at_end;
        return;
    case Why::accepted:
        ++(ours ? out.unexplained : out.ours_wrong);
        return;
    case Why::neither:
        ++out.unexplained;
        return;
    }
}

} // namespace

HitDifferences compare_hits(const Mesh& mesh, const RaySet& set, const Answers& ours, const Answers& theirs)
{
    HitDifferences out;
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        FoundHit a = ours.hits[i], b = theirs.hits[i];
        const bool hit_a = a.triangle != FoundHit::kMiss, hit_b = b.triangle != FoundHit::kMiss;
        if (hit_a == hit_b && (set.occlusion || a.triangle == b.triangle)) continue;
        const FloatRay& ray = set.rays[i];
        if (set.occlusion) {
            if (hit_a) a = closest(ours.engine, ray);
            if (hit_b) b = closest(theirs.engine, ray);
        }
        if (hit_a && hit_b) {
            ++out.other_triangle;
            const double near = std::abs(a.t - b.t) * length(to_double(ray.direction));
            const double size =
                max_component(abs(to_double(ray.origin))) + std::abs(a.t) * length(to_double(ray.direction));
            if (near <= HitDifferences::kRoundings * 0x1p-24 * size)
                ++out.same_t;
            else
                explain(out, mesh, ray, a.t < b.t ? a.triangle : b.triangle, a.t < b.t);
        } else if (hit_a) {
            ++out.only_ours;
            explain(out, mesh, ray, a.triangle, true);
        } else {
            ++out.only_theirs;
            explain(out, mesh, ray, b.triangle, false);
        }
    }
    return out;
}

} // namespace bench
