// prepare_fan: sees whether rays form a fan, and makes it. Included by mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_PREPARE_FAN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_PREPARE_FAN_INL
#undef HELIOGRAPH_PREPARE_FAN_INL
#else
#define HELIOGRAPH_PREPARE_FAN_INL
#endif

#include "renderer/accel/kernel_lanes-inl.h"
#include "renderer/accel/mesh_kernels.h"
#include "renderer/accel/ray_fan.h"
#include "renderer/math/uninitialized.h"

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

using Group = hn::CappedTag<float, RayFan::kGroup>;
inline constexpr unsigned kGroupLanes = hn::MaxLanes(Group());

// The largest slope of a fan; that of a ray along its own main axis is at most 1.
inline constexpr float kSteepest = 1.25f;

// Where the triangles that shadow rays start on are much smaller than what lies between two of the rays, they have few
// leaves in common: when 64 rays have met this many, those that have not hit are followed in another way.
inline constexpr unsigned kLeavesOfFan = 72;
// The same of rays from a camera, which part only where triangles are far smaller than what lies between them.
inline constexpr unsigned kLeavesOfCameraFan = 256;

// Of meshes, whose corners are gathered by their place in 31 bits.
inline constexpr std::size_t kMostBlocks =
    std::size_t{std::numeric_limits<std::int32_t>::max()} / (sizeof(TriangleBlock) / sizeof(float));

// Of a direction, from the sizes of its components.
HWY_INLINE std::size_t main_axis(const Vec3d& size)
{
    return size.x > size.y ? (size.x > size.z ? 0u : 2u) : (size.y > size.z ? 1u : 2u);
}

HWY_INLINE Vec3d end_of(const Ray& ray)
{
    return ray.origin + ray.direction * ray.t_max;
}

// A glance, before rays are looked at closely.
HWY_INLINE bool ends_near(const Ray& ray, const Vec3d& apex)
{
    return max_abs(end_of(ray) - apex) < 0x1p-12 * max_abs(ray.origin - apex);
}

class FanMaker {
public:
    HWY_INLINE FanMaker(RayFan& fan, const MeshView& mesh, const Ray* rays, unsigned count)
        : fan_(fan), mesh_(mesh), rays_(rays), count_(count)
    {
    }

    // False: no fan, or one that float could not tell from its neighbours.
    HWY_INLINE bool make(bool any_hit)
    {
        any_hit_ = any_hit;
        const Ray& first = rays_[0];
        const bool outward = first.origin == rays_[1].origin;
        if (mesh_.scale != 1 || mesh_.blocks > kMostBlocks || (!outward && !any_hit)) return false;
        apex_ = outward ? first.origin : end_of(first);
        if (!apex_is_near() || (!outward && !ends_near(rays_[1], apex_))) return false;
        name_axes(outward);
        for (std::size_t k = 0; k < 3; ++k)
            shift_[k] = apex_[k];
        return outward ? finish<true>() : finish<false>();
    }

private:
    // A mesh that is far away, for its size, is left to those that bring each ray to its bounds.
    HWY_INLINE bool apex_is_near() const
    {
        const Vec3d lower = to_double(mesh_.bounds.lower), upper = to_double(mesh_.bounds.upper);
        const double far = std::max(max_abs(lower - apex_), max_abs(upper - apex_));
        return far < 64 * max_abs(upper - lower); // false for a NaN
    }

    HWY_INLINE void name_axes(bool outward)
    {
        const Vec3d along = rays_[0].direction, size = abs(along);
        fan_.z = main_axis(size);
        fan_.x = fan_.z == 2 ? 0 : fan_.z + 1;
        fan_.y = fan_.x == 2 ? 0 : fan_.x + 1;
        fan_.turned = (along[fan_.z] < 0) == outward;
        fan_.apex = {apex_[fan_.x], apex_[fan_.y], apex_[fan_.z]};
        for (std::size_t k = 0; k < 3; ++k) {
            const double at = k == 2 ? fan_.apex.z * fan_.sign() : fan_.apex[k];
            fan_.apex_high[k] = static_cast<float>(at);
            fan_.apex_low[k] = static_cast<float>(at - static_cast<double>(fan_.apex_high[k]));
        }
        fan_.count = count_;
        fan_.most_leaves = count_ * (any_hit_ ? kLeavesOfFan : kLeavesOfCameraFan) / RayFan::kRays;
        fan_.size = std::max(max_abs(mesh_.bounds.lower), max_abs(mesh_.bounds.upper));
    }

    using V = hn::Vec<Group>;
    static constexpr float kRelative = 0x1p-21f; // what numbers from a few roundings are off by

    // As many rays as a vector has lanes: origins from the apex, directions, t_min and t_max, rounded to float.
    struct FloatRays {
        V from[3], along[3], t_min, t_max;
        HWY_INLINE FloatRays() {} // one that is implied would not be of this target
    };

    HWY_INLINE void read(unsigned first, FloatRays& out) const
    {
        if (first + kGroupLanes <= count_) return narrow(rays_ + first, out);
        Uninitialized<Ray, kGroupLanes> filled_up;
        for (unsigned i = 0; i < kGroupLanes; ++i)
            filled_up[i] = rays_[std::min(first + i, count_ - 1)];
        narrow(filled_up.data(), out);
    }

#if HWY_TARGET == HWY_SCALAR
    HWY_INLINE void narrow(const Ray* ray, FloatRays& out) const
    {
        const Group f;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out.from[axis] = hn::Set(f, static_cast<float>(ray->origin[axis] - apex_[axis]));
            out.along[axis] = hn::Set(f, static_cast<float>(ray->direction[axis]));
        }
        out.t_min = hn::Set(f, static_cast<float>(ray->t_min));
        out.t_max = hn::Set(f, static_cast<float>(ray->t_max));
    }
#else
    HWY_INLINE void narrow(const Ray* rays, FloatRays& out) const
    {
        static_assert(sizeof(Ray) == 8 * sizeof(double));
        narrow_half<true>(rays, out.from[0], out.from[1], out.from[2], out.along[0]);
        narrow_half<false>(rays, out.along[1], out.along[2], out.t_min, out.t_max);
    }

    // Four members of each ray, as vectors of one member each.
    template <bool kOrigins>
    HWY_INLINE void narrow_half(const Ray* rays, V& a, V& b, V& c, V& d) const
    {
        const Group f;
        const hn::RepartitionToWide<Group> pair;
        V some[kQuad];
        for (unsigned i = 0; i < kQuad; ++i) {
            if constexpr (kGroupLanes == 2 * kQuad)
                some[i] = hn::Combine(f, four<kOrigins>(rays[i + kQuad]), four<kOrigins>(rays[i]));
            else
                some[i] = four<kOrigins>(rays[i]);
        }
        const auto lower = [&](V p, V q) HWY_ATTR { return hn::BitCast(pair, hn::InterleaveLower(f, p, q)); };
        const auto upper = [&](V p, V q) HWY_ATTR { return hn::BitCast(pair, hn::InterleaveUpper(f, p, q)); };
        const auto ab = lower(some[0], some[1]), ab_next = lower(some[2], some[3]);
        const auto cd = upper(some[0], some[1]), cd_next = upper(some[2], some[3]);
        a = hn::BitCast(f, hn::InterleaveLower(pair, ab, ab_next));
        b = hn::BitCast(f, hn::InterleaveUpper(pair, ab, ab_next));
        c = hn::BitCast(f, hn::InterleaveLower(pair, cd, cd_next));
        d = hn::BitCast(f, hn::InterleaveUpper(pair, cd, cd_next));
    }

    static constexpr unsigned kQuad = 4;
    using Quad = hn::CappedTag<float, kQuad>;

    template <bool kOrigins>
    HWY_INLINE hn::Vec<Quad> four(const Ray& ray) const
    {
        const Quad f;
        const hn::CappedTag<double, kQuad> d;
        const double* const members = kOrigins ? &ray.origin.x : &ray.direction.y;
        const auto part = [&](std::size_t k) HWY_ATTR {
            const auto given = hn::LoadU(d, members + k);
            return hn::DemoteTo(hn::Rebind<float, decltype(d)>(),
                                kOrigins ? hn::Sub(given, hn::Load(d, shift_ + k)) : given);
        };
        if constexpr (hn::MaxLanes(d) == kQuad)
            return part(0);
        else
            return hn::Combine(f, part(2), part(0));
    }
#endif

    // `blur`: what depths are off by, beside what is relative to them.
    template <bool kOutward>
    HWY_INLINE void keep(unsigned i, V slope_x, V slope_y, V begin, V end, V blur)
    {
        const Group f;
        hn::Store(slope_x, f, fan_.slope_x + i);
        hn::Store(slope_y, f, fan_.slope_y + i);
        blur = hn::Add(blur, hn::Set(f, 0x1p-80f)); // a t_min too small for float
        const auto slack = [&](V at)
                               HWY_ATTR { return hn::MulAdd(hn::Abs(at), hn::Set(f, kRelative), blur); };
        const V slack_of_begin = slack(begin), slack_of_end = slack(end);
        hn::Store(hn::Max(hn::Sub(begin, slack_of_begin), hn::Zero(f)), f, fan_.begin + i);
        hn::Store(hn::Add(begin, slack_of_begin), f, fan_.after + i);
        hn::Store(hn::Add(end, slack_of_end), f, fan_.end + i);
        V before = hn::Sub(end, slack_of_end);
        if constexpr (kOutward) { // of an end at infinity there is no slack
            const auto endless = hn::Eq(end, hn::Set(f, std::numeric_limits<float>::infinity()));
            before = hn::IfThenElse(endless, end, before);
        }
        hn::Store(before, f, fan_.before + i);
    }

    template <bool kOutward>
    HWY_INLINE bool finish()
    {
        const Group f;
        const auto zero = hn::Zero(f), relative = hn::Set(f, kRelative),
                   infinity = hn::Set(f, std::numeric_limits<float>::infinity());
        const auto sign = hn::Set(f, fan_.turned ? -1.0f : 1.0f);
        auto sound = hn::Eq(zero, zero);
        auto aside = zero, reach = zero;
        for (unsigned i = 0; i < fan_.groups() * RayFan::kGroup; i += kGroupLanes) {
            FloatRays rays;
            read(i, rays);
            const auto& from = rays.from;
            const V t_min = rays.t_min, t_max = rays.t_max;
            const V dz = rays.along[fan_.z], inverse = hn::Div(hn::Set(f, 1.0f), dz);
            const V sx = hn::Mul(rays.along[fan_.x], inverse), sy = hn::Mul(rays.along[fan_.y], inverse);
            const V ahead = hn::Mul(kOutward ? dz : hn::Neg(dz), sign);
            // With a NaN anywhere something is not true.
            const auto steepest = hn::Set(f, kSteepest);
            sound = hn::And(sound, hn::And(hn::Le(hn::Abs(sx), steepest), hn::Le(hn::Abs(sy), steepest)));
            sound = hn::And(sound, hn::And(hn::Le(zero, t_min), hn::Lt(t_min, t_max)));
            sound = hn::And(sound, hn::Lt(hn::Set(f, 0x1p-100f), t_max)); // and all its digits are there
            sound = hn::And(sound,
                            hn::And(hn::Lt(hn::Set(f, 0x1p-60f), ahead), hn::Lt(ahead, hn::Set(f, 0x1p60f))));
            V begin = hn::Mul(t_min, ahead), end = hn::Mul(t_max, ahead), blur = zero;
            if constexpr (kOutward) {
                for (const V& component : from)
                    sound = hn::And(sound, hn::Eq(component, zero));
            } else {
                const V depth = hn::Mul(from[fan_.z], sign);
                const V across_x = hn::Abs(from[fan_.x]), across_y = hn::Abs(from[fan_.y]);
                const V size = hn::Max(depth, hn::Max(across_x, across_y));
                const V first = hn::Sub(depth, end);
                end = hn::Sub(depth, begin);
                begin = first;
                blur = hn::Mul(size, relative);
                const V side = hn::Max(hn::Abs(hn::NegMulAdd(sx, from[fan_.z], from[fan_.x])),
                                       hn::Abs(hn::NegMulAdd(sy, from[fan_.z], from[fan_.y])));
                aside = hn::Max(aside, hn::Add(hn::Max(side, hn::Neg(begin)), hn::Add(blur, blur)));
                reach = hn::Max(reach, size);
                sound = hn::And(sound, hn::Lt(zero, depth));
                sound = hn::And(sound, hn::Lt(hn::Add(depth, hn::Add(across_x, across_y)), infinity));
            }
            keep<kOutward>(i, hn::Mul(sx, sign), hn::Mul(sy, sign), begin, end, blur);
        }
        if (!hn::AllTrue(f, sound)) return false;
        fan_.aside = hn::GetLane(hn::MaxOfLanes(f, aside));
        fan_.reach = hn::GetLane(hn::MaxOfLanes(f, reach));
        if (!(fan_.aside <= fan_.reach * 0x1p-16f)) return false;
        const float apex_size = static_cast<float>(max_abs(fan_.apex));
        fan_.blur = 4 * fan_.aside + std::max(fan_.size, apex_size) * 0x1p-44f;
        fan_.rounded = 0;
        if (mesh_.residuals != nullptr) { // floats are within 2^-24 of the corners
            fan_.rounded = 2 * fan_.size;
            fan_.blur += fan_.size * 0x1p-22f;
        }
        bound_groups();
        return true;
    }

    struct Lesser {
        HWY_INLINE V operator()(V a, V b) const { return hn::Min(a, b); }
        HWY_INLINE float of_lanes(V v) const { return hn::GetLane(hn::MinOfLanes(Group(), v)); }
    };
    struct Greater {
        HWY_INLINE V operator()(V a, V b) const { return hn::Max(a, b); }
        HWY_INLINE float of_lanes(V v) const { return hn::GetLane(hn::MaxOfLanes(Group(), v)); }
    };

    // Of each group's values the best, and of all of them.
    template <class Better>
    static HWY_INLINE float find_best(const float* values, float* of_groups, Better better)
    {
        const Group f;
        alignas(64) float of_halves[2 * RayFan::kGroups];
        static_assert(RayFan::kGroup == 2 * 4);
        for (unsigned i = 0; i < RayFan::kRays; i += 4 * kGroupLanes) {
            V v[4];
            hn::LoadInterleaved4(f, values + i, v[0], v[1], v[2], v[3]);
            hn::Store(better(better(v[0], v[1]), better(v[2], v[3])), f, of_halves + i / 4);
        }
        V best;
        for (unsigned g = 0; g < RayFan::kGroups; g += kGroupLanes) {
            V first, second;
            hn::LoadInterleaved2(f, of_halves + std::size_t{2} * g, first, second);
            const auto of_group = better(first, second);
            hn::Store(of_group, f, of_groups + g);
            best = g == 0 ? of_group : better(best, of_group);
        }
        return better.of_lanes(best);
    }

    HWY_INLINE void bound_groups()
    {
        // Groups that are not there are as the first one, and have ended.
        for (unsigned i = fan_.groups() * RayFan::kGroup; i < RayFan::kRays; ++i) {
            fan_.slope_x[i] = fan_.slope_x[0];
            fan_.slope_y[i] = fan_.slope_y[0];
            fan_.begin[i] = fan_.begin[0];
            fan_.end[i] = -std::numeric_limits<float>::infinity();
        }
        fan_.all_least_x = find_best(fan_.slope_x, fan_.least_x, Lesser());
        fan_.all_most_x = find_best(fan_.slope_x, fan_.most_x, Greater());
        fan_.all_least_y = find_best(fan_.slope_y, fan_.least_y, Lesser());
        fan_.all_most_y = find_best(fan_.slope_y, fan_.most_y, Greater());
        fan_.all_begin = find_best(fan_.begin, fan_.group_begin, Lesser());
        find_best(fan_.end, fan_.group_end, Greater());
        halve(fan_.all_least_x, fan_.all_most_x, fan_.middle_x, fan_.half_x);
        halve(fan_.all_least_y, fan_.all_most_y, fan_.middle_y, fan_.half_y);
    }

    static HWY_INLINE void halve(float least, float most, float& middle, float& half)
    {
        middle = (least + most) / 2;
        half = (most - least) * (0.5f + 0x1p-20f) + std::abs(middle) * 0x1p-22f;
    }

    RayFan& fan_;
    const MeshView& mesh_;
    const Ray* rays_;
    unsigned count_;
    bool any_hit_ = false;
    Vec3d apex_;
    alignas(32) double shift_[4] = {}; // of a ray's first four members
};

// Fewer rays than kFewestOfFan are not worth it.
inline constexpr unsigned kFewestOfFan = 8;

HWY_INLINE bool prepare_fan(RayFan& fan, const MeshView& mesh, const Ray* rays, unsigned count, bool any_hit)
{
    return count >= kFewestOfFan && FanMaker(fan, mesh, rays, count).make(any_hit);
}

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
