// FanFindings: what the rays of a fan have found, and the exact tests that are left. Included by mesh_kernels.cpp,
// once a target.
#if defined(HELIOGRAPH_SETTLE_FAN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_SETTLE_FAN_INL
#undef HELIOGRAPH_SETTLE_FAN_INL
#else
#define HELIOGRAPH_SETTLE_FAN_INL
#endif

#include "renderer/accel/exact_ray.h"
#include "renderer/accel/exact_test.h"
#include "renderer/accel/prepare_fan-inl.h"
#include "renderer/accel/triangle_lanes-inl.h"

#include <array>
#include <bit>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// Triangles are told by number: block * TriangleBlock::kLanes + lane.
template <bool kAnyHit>
class FanFindings {
public:
    HWY_INLINE FanFindings(const MeshView& mesh, RayFan& fan, const Ray* rays, MeshHit* best)
        : mesh_(mesh), fan_(fan), rays_(rays), best_(best)
    {
    }

    // Rays first, first + 1, ... as `lanes` says, hit for certain.
    HWY_INLINE void hit(unsigned first, unsigned lanes) { found_ |= std::uint64_t{lanes} << first; }

    // They hit this triangle, nearer than any other that is certain.
    HWY_INLINE void prefer(unsigned first, hn::Mask<Group> hits, unsigned lanes, std::uint32_t triangle)
    {
        const hn::RebindToUnsigned<Group> u;
        preferring_ |= std::uint64_t{lanes} << first;
        std::uint32_t* const at = preferred_ + first;
        hn::Store(hn::IfThenElse(hn::RebindMask(u, hits), hn::Set(u, triangle), hn::Load(u, at)), u, at);
    }

    // Float cannot tell whether they hit it, or whether before what they prefer. True where a ray's end was drawn
    // in.
    HWY_INLINE bool ask(unsigned first, unsigned lanes, std::uint32_t triangle)
    {
        bool drawn = false;
        for (; lanes != 0; lanes &= lanes - 1) {
            const unsigned ray = first + static_cast<unsigned>(__builtin_ctz(lanes));
            if (ray >= fan_.count) break;
            if (kAnyHit && (found_ >> ray & 1) != 0) continue;
            asked_[count_++] = {ray, triangle};
            if (count_ == kMostAsked) drawn = answer() || drawn;
        }
        return drawn;
    }

    // Rays that have not hit as far as is known.
    HWY_INLINE unsigned missing() const
    {
        return static_cast<unsigned>(std::popcount(rays_there() & ~found_));
    }

    HWY_INLINE void bound_group(unsigned group)
    {
        const Group f;
        const float* const ends = fan_.end + std::size_t{group} * RayFan::kGroup;
        auto most = hn::Load(f, ends);
        for (unsigned i = kGroupLanes; i < RayFan::kGroup; i += kGroupLanes)
            most = hn::Max(most, hn::Load(f, ends + i));
        fan_.group_end[group] = hn::GetLane(hn::MaxOfLanes(f, most));
    }

    // The exact hits. Bit i: ray i hit.
    HWY_INLINE std::uint64_t settle()
    {
        if constexpr (!kAnyHit) settle_preferred();
        answer();
        found_ &= rays_there();
        if constexpr (!kAnyHit)
            for (std::uint64_t missed = rays_there() & ~found_; missed != 0; missed &= missed - 1)
                best_[__builtin_ctzll(missed)] = kNothing;
        return found_;
    }

private:
    using D = TriangleLanes::D;
    using V = TriangleLanes::V;
    using F = hn::Rebind<float, D>;
    static constexpr unsigned kTogether = TriangleLanes::kLanes;
    // The nearest hit draws the rays' ends in and so leaves out many; any hit ends its ray, so that it is asked for soon.
    static constexpr unsigned kMostAsked = kAnyHit ? kTogether : 128;

    struct Asked {
        unsigned ray;
        std::uint32_t triangle;
    };

    static constexpr MeshHit kNothing{std::numeric_limits<double>::infinity(), TriangleBlock::kNone, {}};

    HWY_INLINE std::uint64_t rays_there() const { return ~std::uint64_t{0} >> (64 - fan_.count); }

    HWY_INLINE void settle_preferred()
    {
        preferring_ &= rays_there();
        for (unsigned first = 0; first < RayFan::kRays; first += kTogether)
            if (const auto lanes = static_cast<unsigned>(preferring_ >> first) & ((1u << kTogether) - 1);
                lanes != 0)
                settle_some(first, lanes);
    }

    using Axes = std::array<std::size_t, 3>;
    static constexpr int kLaneBits = std::countr_zero(TriangleBlock::kLanes),
                         kRayStride = sizeof(Ray) / sizeof(double);

    // As WatertightRay names them; all rays of a fan alike.
    HWY_INLINE Axes exact_axes(const Ray& ray) const
    {
        return ray.direction[fan_.z] < 0 ? Axes{fan_.y, fan_.x, fan_.z} : Axes{fan_.x, fan_.y, fan_.z};
    }

    HWY_INLINE double corner(std::uint32_t triangle, std::size_t k, std::size_t axis) const
    {
        const std::uint32_t block = triangle / TriangleBlock::kLanes, lane = triangle % TriangleBlock::kLanes;
        const auto in_float = static_cast<double>(mesh_.leaves[block].corners[k][axis][lane]);
        return mesh_.residuals == nullptr
                   ? in_float
                   : in_float + static_cast<double>(mesh_.residuals[block].corners[k][axis][lane]);
    }

    HWY_INLINE void
    gather_corners(hn::Vec<hn::RebindToUnsigned<F>> triangles, const Axes& axes, V (&out)[3][3]) const
    {
        gather<sizeof(TriangleBlock)>(triangles, mesh_.leaves->corners, axes, out);
        if (mesh_.residuals == nullptr) return;
        V lacking[3][3];
        gather<sizeof(CornerResiduals)>(triangles, mesh_.residuals->corners, axes, lacking);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                out[k][axis] = hn::Add(out[k][axis], lacking[k][axis]);
    }

    // From blocks of this many bytes.
    template <std::size_t kBytes>
    HWY_INLINE void gather(hn::Vec<hn::RebindToUnsigned<F>> triangles,
                           const float (&corners)[3][3][TriangleBlock::kLanes],
                           const Axes& axes,
                           V (&out)[3][3]) const
    {
        const D d;
        const F f;
        const hn::RebindToUnsigned<F> u;
        const auto block = hn::ShiftRight<kLaneBits>(triangles),
                   lane = hn::And(triangles, hn::Set(u, TriangleBlock::kLanes - 1));
        const auto at = hn::BitCast(hn::RebindToSigned<F>(),
                                    hn::Add(hn::Mul(block, hn::Set(u, kBytes / sizeof(float))), lane));
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                out[k][axis] = hn::PromoteTo(d, hn::GatherIndex(f, corners[k][axes[axis]], at));
    }

    // Of rays first, first + 1, ... those of `lanes`, which float has said hit.
    HWY_INLINE void settle_some(unsigned first, unsigned lanes)
    {
        const D d;
        const hn::RebindToUnsigned<F> u;
        const std::uint32_t* const preferred = preferred_ + first;
        const std::uint32_t some = preferred[__builtin_ctz(lanes)];
        const Axes axes = exact_axes(rays_[0]);
        const auto triangles = hn::Load(u, preferred);
        V corners[3][3];
        if ((bits_of(u, hn::Ne(triangles, hn::Set(u, some))) & lanes) == 0) {
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    corners[k][axis] = hn::Set(d, corner(some, k, axes[axis]));
        } else {
            gather_corners(triangles, axes, corners);
        }
        V origin[3], direction[3];
        const hn::RebindToSigned<D> i64;
        // Lanes without a ray take the last one.
        const auto last = hn::Set(i64, fan_.count - 1 - first);
        const auto ray = hn::Mul(hn::Min(hn::Iota(i64, 0), last), hn::Set(i64, kRayStride));
        const Ray* const rays = rays_ + first;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin[axis] = hn::Set(d, (&rays->origin.x)[axes[axis]]);
            direction[axis] = hn::GatherIndex(d, &rays->direction.x + axes[axis], ray);
        }
        const KernelUnits units(direction);
        const TriangleLanes exact(
            origin, direction, [&](std::size_t k, std::size_t axis) HWY_ATTR { return corners[k][axis]; });
        // Float's bounds hold for what double computes: the depth need not be compared with the ray's range once more.
        Found found;
        found.store(exact, units, exact.is_plain());
        for (; lanes != 0; lanes &= lanes - 1) {
            const auto i = static_cast<unsigned>(__builtin_ctz(lanes));
            if ((found.told >> i & 1) == 0)
                answer_one({first + i, preferred[i]});
            else if (improve(first + i, found.hit(i, mesh_, preferred[i])))
                found_ |= std::uint64_t{1} << (first + i);
        }
    }

    HWY_INLINE bool decide(unsigned ray, std::uint32_t triangle, MeshHit& best) const
    {
        const ExactRay exact(rays_[ray], static_cast<double>(mesh_.scale));
        return improve_hit(exact.ray,
                           exact.t_min,
                           exact.t_max,
                           mesh_,
                           mesh_.leaves[triangle / TriangleBlock::kLanes],
                           triangle % TriangleBlock::kLanes,
                           best);
    }

    // One by one, where lanes do not tell. `best_` counts t in kernel units until then.
    HWY_NOINLINE bool answer_one(const Asked& asked)
    {
        const auto [ray, triangle] = asked;
        MeshHit hit = kNothing;
        if (!decide(ray, triangle, hit)) return false;
        hit.t *= power_for(max_component(abs(rays_[ray].direction))) / static_cast<double>(mesh_.scale);
        return take(ray, hit);
    }

    HWY_INLINE bool improve(unsigned ray, const MeshHit& hit)
    {
        if constexpr (kAnyHit) return true;
        MeshHit& best = best_[ray];
        if ((found_ >> ray & 1) != 0 &&
            !(hit.t < best.t || (hit.t == best.t && hit.primitive < best.primitive)))
            return false;
        best = hit;
        return true;
    }

    // True where a ray's end was drawn in.
    HWY_INLINE bool take(unsigned ray, const MeshHit& hit)
    {
        if (!improve(ray, hit)) return false;
        found_ |= std::uint64_t{1} << ray;
        if constexpr (kAnyHit) {
            fan_.end[ray] = -std::numeric_limits<float>::infinity();
        } else {
            const auto depth = static_cast<float>(hit.t * std::abs(rays_[ray].direction[fan_.z]));
            fan_.end[ray] = std::min(fan_.end[ray], depth + depth * 0x1p-21f + 0x1p-80f);
        }
        bound_group(ray / RayFan::kGroup);
        return true;
    }

    // The exact tests that were put off. True where a ray's end was drawn in.
    bool answer()
    {
        bool drawn = false;
        for (unsigned i = 0; i < count_; i += kTogether)
            drawn = test_some(asked_ + i, std::min(kTogether, count_ - i)) || drawn;
        count_ = 0;
        return drawn;
    }

    // What brings rays to a direction near 1 along the fan, the kernel's units, and t back. mesh.scale is 1, and powers
    // of two have exact inverses.
    struct KernelUnits {
        V power, inverse;

        HWY_INLINE explicit KernelUnits(V (&direction)[3])
        {
            const D d;
            const hn::RebindToUnsigned<D> u;
            const auto exponent =
                hn::And(hn::BitCast(u, hn::Abs(direction[2])), hn::Set(u, std::uint64_t{0x7ff} << 52));
            power = hn::BitCast(d, hn::Sub(hn::Set(u, std::uint64_t{0x7fe} << 52), exponent));
            inverse = hn::BitCast(d, exponent);
            for (V& component : direction)
                component = hn::Mul(component, power);
        }
    };

    // What lanes of rays found, each in a triangle of its own.
    struct Found {
        unsigned told; // bit i: ray i's answer is as computed; the others are left to the test of one ray
        alignas(64) double t[kTogether], weights[3][kTogether];

        // `plain`: where the weights need not be drawn onto the ray.
        HWY_INLINE void store(const TriangleLanes& exact, const KernelUnits& units, hn::Mask<D> plain)
        {
            const D d;
            told = bits_of(d, hn::And(plain, exact.runs_along_third())); // the axes are the fan's
            hn::Store(hn::Mul(exact.t(), units.power), d, t);
            for (std::size_t k = 0; k < 3; ++k)
                hn::Store(exact.weight(k), d, weights[k]);
        }
        HWY_INLINE MeshHit hit(unsigned i, const MeshView& mesh, std::uint32_t triangle) const
        {
            const TriangleBlock& block = mesh.leaves[triangle / TriangleBlock::kLanes];
            return {t[i],
                    block.primitive[triangle % TriangleBlock::kLanes],
                    {weights[0][i], weights[1][i], weights[2][i]}};
        }
    };

    // True where a ray's end was drawn in.
    HWY_INLINE bool test_some(Asked* asked, unsigned count)
    {
        const D d;
        const hn::RebindToUnsigned<F> u;
        for (unsigned i = count; i < kTogether; ++i)
            asked[i] = asked[0];
        hn::Vec<decltype(u)> ray_numbers, triangles;
        hn::LoadInterleaved2(u, &asked->ray, ray_numbers, triangles);
        const auto ray =
            hn::Mul(hn::PromoteTo(hn::RebindToSigned<D>(), hn::BitCast(hn::RebindToSigned<F>(), ray_numbers)),
                    hn::Set(hn::RebindToSigned<D>(), kRayStride));
        const Axes axes = exact_axes(rays_[asked[0].ray]);
        V origin[3], direction[3], corner[3][3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin[axis] = hn::GatherIndex(d, &rays_->origin.x + axes[axis], ray);
            direction[axis] = hn::GatherIndex(d, &rays_->direction.x + axes[axis], ray);
        }
        const V t_min = hn::GatherIndex(d, &rays_->t_min, ray),
                t_max = hn::GatherIndex(d, &rays_->t_max, ray);
        gather_corners(triangles, axes, corner);
        const KernelUnits units(direction);
        const TriangleLanes exact(
            origin, direction, [&](std::size_t k, std::size_t axis) HWY_ATTR { return corner[k][axis]; });
        const V t = exact.t(), begin = hn::Mul(t_min, units.inverse);
        const V end = hn::Mul(t_max, units.inverse);
        const auto plain = exact.is_plain();
        const unsigned hits = bits_of(d,
                                      hn::And(hn::And(plain, hn::And(hn::Lt(begin, t), hn::Lt(t, end))),
                                              hn::Gt(exact.lower_bound_of_t(), begin)));
        Found found;
        found.store(exact, units, hn::Or(plain, exact.beside()));
        bool drawn = false;
        for (unsigned i = 0; i < count; ++i) {
            if ((found.told >> i & 1) == 0)
                drawn = answer_one(asked[i]) || drawn;
            else if ((hits >> i & 1) != 0)
                drawn = take(asked[i].ray, found.hit(i, mesh_, asked[i].triangle)) || drawn;
        }
        return drawn;
    }

    const MeshView& mesh_;
    RayFan& fan_;
    const Ray* rays_;
    MeshHit* best_;
    std::uint64_t found_ = 0, preferring_ = 0;
    unsigned count_ = 0;
    alignas(64) std::uint32_t preferred_[kAnyHit ? 1 : RayFan::kRays] = {}; // of the nearest hits
    Asked asked_[kMostAsked];
};

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
