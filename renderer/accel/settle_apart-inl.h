// LoneTests: the double tests that rays which have nothing in common are left with, several at once. Included by
// mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_SETTLE_APART_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_SETTLE_APART_INL
#undef HELIOGRAPH_SETTLE_APART_INL
#else
#define HELIOGRAPH_SETTLE_APART_INL
#endif

#include "renderer/accel/exact_test.h"
#include "renderer/accel/lone_rays.h"
#include "renderer/accel/mesh_kernels.h"
#include "renderer/accel/triangle_lanes-inl.h"

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// Triangles are told by place: block * TriangleBlock::kLanes + lane.
inline std::uint32_t primitive_at(const MeshView& mesh, std::uint32_t place)
{
    return mesh.leaves[place / TriangleBlock::kLanes].primitive[place % TriangleBlock::kLanes];
}

class LoneTests {
public:
    HWY_INLINE LoneTests(const MeshView& mesh, const LoneRays& run, const Ray* rays, MeshHit* best)
        : mesh_(mesh), run_(run), rays_(rays), best_(best)
    {
    }

    // Whether the triangle becomes the ray's best hit: now.
    HWY_NOINLINE void test(unsigned ray, std::uint32_t place) const
    {
        const Ray& r = rays_[ray];
        const double units = run_.units[ray];
        const WatertightRay<double> exact(r.origin * static_cast<double>(mesh_.scale),
                                          r.direction * run_.power[ray]);
        improve_hit(exact,
                    r.t_min * units,
                    r.t_max * units,
                    mesh_,
                    mesh_.leaves[place / TriangleBlock::kLanes],
                    place % TriangleBlock::kLanes,
                    best_[ray]);
    }

    // The same, some time until finish(), with others.
    HWY_INLINE void ask(unsigned ray, std::uint32_t place)
    {
        asked_[count_++] = {ray, place};
        if (count_ == kTogether) finish();
    }
    HWY_INLINE void finish()
    {
        if (count_ != 0) test_asked();
        count_ = 0;
    }

private:
    struct Asked {
        unsigned ray;
        std::uint32_t place;
    };
    using D = TriangleLanes::D;
    using V = TriangleLanes::V;
    static constexpr unsigned kTogether = TriangleLanes::kLanes;
    static constexpr std::size_t kRow = sizeof(TriangleBlock::corners[0][0]); // LoneRays::Axes count bytes

    // Rays and their triangles side by side, axes renamed; the last lanes may repeat the first.
    struct Batch {
        alignas(64) float corners[9][kTogether], lacking[9][kTogether];
        alignas(64) double origins[3][kTogether], directions[3][kTogether];
        alignas(64) double powers[kTogether], units[kTogether], from[kTogether], to[kTogether];
    };
    HWY_INLINE void load(Batch& batch) const
    {
        const bool has_residuals = mesh_.residuals != nullptr;
        for (unsigned i = 0; i < kTogether; ++i) {
            const Asked& one = asked_[i < count_ ? i : 0];
            const Ray& ray = rays_[one.ray];
            const LoneRays::Axes named = run_.axes[one.ray];
            const std::size_t axes[3] = {named.x / kRow, named.y / kRow, named.z / kRow};
            const std::uint32_t block = one.place / TriangleBlock::kLanes;
            const std::uint32_t lane = one.place % TriangleBlock::kLanes;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (std::size_t k = 0; k < 3; ++k) {
                    batch.corners[3 * k + axis][i] = mesh_.leaves[block].corners[k][axes[axis]][lane];
                    if (has_residuals)
                        batch.lacking[3 * k + axis][i] = mesh_.residuals[block].corners[k][axes[axis]][lane];
                }
                batch.origins[axis][i] = ray.origin[axes[axis]];
                batch.directions[axis][i] = ray.direction[axes[axis]];
            }
            batch.powers[i] = run_.power[one.ray];
            batch.units[i] = run_.units[one.ray];
            batch.from[i] = ray.t_min;
            batch.to[i] = ray.t_max;
        }
    }

    HWY_INLINE void test_asked() const
    {
        const D d;
        const hn::Rebind<float, D> f;
        const bool has_residuals = mesh_.residuals != nullptr;
        Batch batch;
        load(batch);
        const V scale = hn::Set(d, static_cast<double>(mesh_.scale)), power = hn::Load(d, batch.powers);
        V origin[3], direction[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin[axis] = hn::Mul(hn::Load(d, batch.origins[axis]), scale);
            direction[axis] = hn::Mul(hn::Load(d, batch.directions[axis]), power);
        }
        const TriangleLanes exact(origin, direction, [&](std::size_t k, std::size_t axis) HWY_ATTR {
            const V corner = hn::PromoteTo(d, hn::Load(f, batch.corners[3 * k + axis]));
            return has_residuals ? hn::Add(corner, hn::PromoteTo(d, hn::Load(f, batch.lacking[3 * k + axis])))
                                 : corner;
        });
        const V t = exact.t(), unit = hn::Load(d, batch.units);
        const V begin = hn::Mul(hn::Load(d, batch.from), unit), end = hn::Mul(hn::Load(d, batch.to), unit);
        const auto within =
            hn::And(hn::And(hn::Lt(t, end), hn::Gt(t, begin)), hn::Gt(exact.lower_bound_of_t(), begin));
        const auto plain = exact.is_plain();
        const unsigned hit = bits_of(d, hn::And(plain, within));
        const unsigned known = bits_of(d, hn::Or(plain, exact.beside()));
        alignas(64) double out[4][kTogether];
        hn::Store(t, d, out[0]);
        for (std::size_t k = 0; k < 3; ++k)
            hn::Store(exact.weight(k), d, out[1 + k]);
        for (unsigned i = 0; i < count_; ++i) {
            const Asked& one = asked_[i];
            MeshHit& best = best_[one.ray];
            if ((known >> i & 1) == 0) {
                test(one.ray, one.place);
                continue;
            }
            if ((hit >> i & 1) == 0) continue;
            const std::uint32_t number = primitive_at(mesh_, one.place);
            if (out[0][i] < best.t || (out[0][i] == best.t && number < best.primitive))
                best = {out[0][i], number, {out[1][i], out[2][i], out[3][i]}};
        }
    }

    const MeshView& mesh_;
    const LoneRays& run_;
    const Ray* rays_;
    MeshHit* best_;
    unsigned count_ = 0;
    Asked asked_[kTogether];
};

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
