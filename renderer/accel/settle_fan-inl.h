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
        if (kAnyHit) return;
        for (unsigned i = 0; i < fan.count; ++i) {
            best[i].t = std::numeric_limits<double>::infinity();
            best[i].primitive = TriangleBlock::kNone;
        }
    }

    // Rays first, first + 1, ... as `lanes` says, hit for certain.
    HWY_INLINE void hit(unsigned first, unsigned lanes) { found_ |= std::uint64_t{lanes} << first; }

    // They hit this triangle, nearer than any other that is certain.
    HWY_INLINE void prefer(unsigned first, unsigned lanes, std::uint32_t triangle)
    {
        preferring_ |= std::uint64_t{lanes} << first;
        for (; lanes != 0; lanes &= lanes - 1)
            preferred_[first + static_cast<unsigned>(__builtin_ctz(lanes))] = triangle;
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
        return found_ & rays_there();
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

    HWY_INLINE std::uint64_t rays_there() const { return ~std::uint64_t{0} >> (64 - fan_.count); }

    HWY_INLINE void settle_preferred()
    {
        preferring_ &= rays_there();
        found_ |= preferring_;
        Asked some[kTogether];
        unsigned count = 0;
        for (std::uint64_t left = preferring_; left != 0;) {
            const auto ray = static_cast<unsigned>(__builtin_ctzll(left));
            some[count++] = {ray, preferred_[ray]};
            left &= left - 1;
            if (count < kTogether && left != 0) continue;
            test_some<true>(some, count);
            count = 0;
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
        MeshHit hit{std::numeric_limits<double>::infinity(), TriangleBlock::kNone, {}};
        if (!decide(ray, triangle, hit)) return false;
        hit.t *= power_for(max_component(abs(rays_[ray].direction))) / static_cast<double>(mesh_.scale);
        return take(ray, hit);
    }

    HWY_INLINE bool improve(unsigned ray, const MeshHit& hit)
    {
        if constexpr (kAnyHit) return true;
        MeshHit& best = best_[ray];
        if (!(hit.t < best.t || (hit.t == best.t && hit.primitive < best.primitive))) return false;
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
            drawn = test_some<false>(asked_ + i, std::min(kTogether, count_ - i)) || drawn;
        count_ = 0;
        return drawn;
    }

    // kCertain: float has said that they hit. True where a ray's end was drawn in.
    template <bool kCertain>
    HWY_INLINE bool test_some(const Asked* asked, unsigned count)
    {
        const D d;
        const F f;
        std::size_t kx = fan_.x, ky = fan_.y;
        if (rays_[asked[0].ray].direction[fan_.z] < 0) std::swap(kx, ky);
        const std::size_t axes[3] = {kx, ky, fan_.z};
        alignas(64) float corners[9][kTogether];
        alignas(64) double origins[3][kTogether], directions[3][kTogether], from[kTogether], to[kTogether];
        for (unsigned i = 0; i < kTogether; ++i) {
            const auto [ray, triangle] = asked[i < count ? i : 0];
            const TriangleBlock& block = mesh_.leaves[triangle / TriangleBlock::kLanes];
            const unsigned lane = triangle % TriangleBlock::kLanes;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (std::size_t k = 0; k < 3; ++k)
                    corners[3 * k + axis][i] = block.corners[k][axes[axis]][lane];
                origins[axis][i] = rays_[ray].origin[axes[axis]];
                directions[axis][i] = rays_[ray].direction[axes[axis]];
            }
            from[i] = rays_[ray].t_min;
            to[i] = rays_[ray].t_max;
        }
        const hn::RebindToUnsigned<D> du;
        const V size = hn::Abs(hn::Load(d, directions[2]));
        const auto exponent = hn::And(hn::BitCast(du, size), hn::Set(du, std::uint64_t{0x7ff} << 52));
        // mesh.scale is 1, and powers of two have exact inverses.
        const V power = hn::BitCast(d, hn::Sub(hn::Set(du, std::uint64_t{0x7fe} << 52), exponent));
        const V inverse = hn::BitCast(d, exponent);
        const V origin[3] = {hn::Load(d, origins[0]), hn::Load(d, origins[1]), hn::Load(d, origins[2])};
        const V direction[3] = {hn::Mul(hn::Load(d, directions[0]), power),
                                hn::Mul(hn::Load(d, directions[1]), power),
                                hn::Mul(hn::Load(d, directions[2]), power)};
        const TriangleLanes exact(origin, direction, [&](std::size_t k, std::size_t axis) HWY_ATTR {
            return hn::PromoteTo(d, hn::Load(f, corners[3 * k + axis]));
        });
        const V t = exact.t(), begin = hn::Mul(hn::Load(d, from), inverse);
        auto within = hn::And(hn::Lt(begin, t), hn::Lt(t, hn::Mul(hn::Load(d, to), inverse)));
        // Where the weights need not be drawn onto the ray, the axes are the fan's; the rest is as float said.
        const auto plain = exact.is_plain();
        auto known = hn::And(plain, within);
        if constexpr (!kCertain) {
            within = hn::And(known, hn::Gt(exact.lower_bound_of_t(), begin));
            known = hn::Or(plain, exact.beside());
        }
        const unsigned hits = bits_of(d, within);
        const unsigned told = bits_of(d, hn::And(known, exact.runs_along_third()));
        alignas(64) double out[4][kTogether];
        hn::Store(hn::Mul(t, power), d, out[0]);
        for (std::size_t k = 0; k < 3; ++k)
            hn::Store(exact.weight(k), d, out[1 + k]);
        bool drawn = false;
        for (unsigned i = 0; i < count; ++i) {
            const auto [ray, triangle] = asked[i];
            if ((told >> i & 1) == 0) {
                drawn = answer_one(asked[i]) || drawn;
            } else if ((hits >> i & 1) != 0) {
                const TriangleBlock& block = mesh_.leaves[triangle / TriangleBlock::kLanes];
                const MeshHit hit{out[0][i],
                                  block.primitive[triangle % TriangleBlock::kLanes],
                                  {out[1][i], out[2][i], out[3][i]}};
                drawn = (kCertain ? improve(ray, hit) : take(ray, hit)) || drawn; // certain ones are found
            }
        }
        return drawn;
    }

    const MeshView& mesh_;
    RayFan& fan_;
    const Ray* rays_;
    MeshHit* best_;
    std::uint64_t found_ = 0, preferring_ = 0;
    unsigned count_ = 0;
    std::uint32_t preferred_[RayFan::kRays];
    Asked asked_[kMostAsked];
};

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
