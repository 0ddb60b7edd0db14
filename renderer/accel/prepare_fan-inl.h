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
inline constexpr unsigned kLeavesOfFan = 48;
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
        apex_ = outward ? first.origin : first.origin + first.direction * first.t_max;
        if (!apex_is_near() || (!outward && !ends_near_apex(rays_[1]))) return false;
        name_axes(outward);
        load();
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

    // A glance at another ray, before all are looked at closely.
    HWY_INLINE bool ends_near_apex(const Ray& ray) const
    {
        return max_abs(ray.origin + ray.direction * ray.t_max - apex_) <
               0x1p-12 * max_abs(ray.origin - apex_);
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

    // Origins from the apex, directions, t_min and t_max, rounded to float.
    HWY_INLINE void load()
    {
        const hn::CappedTag<double, 4> d;
        const hn::Rebind<float, decltype(d)> f;
        static_assert(sizeof(Ray) == 8 * sizeof(double));
        alignas(32) const double apex[4] = {apex_.x, apex_.y, apex_.z, 0};
        const unsigned lanes = fan_.groups() * RayFan::kGroup;
        for (unsigned i = 0; i < lanes; ++i) {
            const Ray& given = rays_[std::min(i, count_ - 1)];
            const double* const ray = &given.origin.x;
            for (std::size_t k = 0; k < 4; k += hn::MaxLanes(d)) {
                hn::Store(hn::DemoteTo(f, hn::Sub(hn::LoadU(d, ray + k), hn::Load(d, apex + k))),
                          f,
                          first_half_[i] + k);
                hn::Store(hn::DemoteTo(f, hn::LoadU(d, ray + 4 + k)), f, second_half_[i] + k);
            }
        }
    }

    template <bool kOutward>
    HWY_INLINE bool finish()
    {
        const Group f;
        using V = hn::Vec<Group>;
        const auto zero = hn::Zero(f), relative = hn::Set(f, 0x1p-21f),
                   infinity = hn::Set(f, std::numeric_limits<float>::infinity());
        const auto sign = hn::Set(f, fan_.turned ? -1.0f : 1.0f);
        auto sound = hn::Eq(zero, zero);
        auto aside = zero, reach = zero;
        for (unsigned i = 0; i < fan_.groups() * RayFan::kGroup; i += kGroupLanes) {
            V from[3], along[3], t_min, t_max;
            hn::LoadInterleaved4(f, first_half_[i], from[0], from[1], from[2], along[0]);
            hn::LoadInterleaved4(f, second_half_[i], along[1], along[2], t_min, t_max);
            const V dz = along[fan_.z], speed = hn::Abs(dz);
            const V sx = hn::Div(along[fan_.x], dz), sy = hn::Div(along[fan_.y], dz);
            // With a NaN anywhere something is not true.
            const auto steepest = hn::Set(f, kSteepest);
            sound = hn::And(sound, hn::And(hn::Le(hn::Abs(sx), steepest), hn::Le(hn::Abs(sy), steepest)));
            sound = hn::And(sound, hn::And(hn::Le(zero, t_min), hn::Lt(t_min, t_max)));
            sound = hn::And(sound, hn::Lt(hn::Set(f, 0x1p-100f), t_max)); // and all its digits are there
            sound = hn::And(sound,
                            hn::And(hn::Lt(hn::Set(f, 0x1p-60f), speed), hn::Lt(speed, hn::Set(f, 0x1p60f))));
            sound = hn::And(sound, hn::Lt(zero, hn::Mul(kOutward ? dz : hn::Neg(dz), sign)));
            V begin = hn::Mul(t_min, speed), end = hn::Mul(t_max, speed), blur = zero;
            if constexpr (kOutward) {
                for (const V& component : from)
                    sound = hn::And(sound, hn::Eq(component, zero));
            } else {
                const V depth = hn::Mul(from[fan_.z], sign);
                const V size = hn::Max(hn::Abs(from[0]), hn::Max(hn::Abs(from[1]), hn::Abs(from[2])));
                const V first = hn::Sub(depth, end);
                end = hn::Sub(depth, begin);
                begin = first;
                blur = hn::Mul(size, relative);
                const V side = hn::Max(hn::Abs(hn::NegMulAdd(sx, from[fan_.z], from[fan_.x])),
                                       hn::Abs(hn::NegMulAdd(sy, from[fan_.z], from[fan_.y])));
                aside = hn::Max(aside, hn::Add(hn::Max(side, hn::Neg(begin)), hn::Add(blur, blur)));
                reach = hn::Max(reach, size);
                for (const V& component : from)
                    sound = hn::And(sound, hn::Lt(hn::Abs(component), infinity));
                sound = hn::And(sound, hn::Lt(zero, depth));
            }
            hn::Store(hn::Mul(sx, sign), f, fan_.slope_x + i);
            hn::Store(hn::Mul(sy, sign), f, fan_.slope_y + i);
            blur = hn::Add(blur, hn::Set(f, 0x1p-80f)); // a t_min too small for float
            const auto slack = [&](V at) HWY_ATTR { return hn::Add(hn::Mul(hn::Abs(at), relative), blur); };
            hn::Store(hn::Max(hn::Sub(begin, slack(begin)), zero), f, fan_.begin + i);
            hn::Store(hn::Add(begin, slack(begin)), f, fan_.after + i);
            hn::Store(hn::Add(end, slack(end)), f, fan_.end + i);
            // Of an end at infinity there is no slack.
            hn::Store(
                hn::IfThenElse(hn::Eq(end, infinity), end, hn::Sub(end, slack(end))), f, fan_.before + i);
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
        HWY_INLINE hn::Vec<Group> operator()(hn::Vec<Group> a, hn::Vec<Group> b) const
        {
            return hn::Min(a, b);
        }
        HWY_INLINE float of_lanes(hn::Vec<Group> v) const { return hn::GetLane(hn::MinOfLanes(Group(), v)); }
    };
    struct Greater {
        HWY_INLINE hn::Vec<Group> operator()(hn::Vec<Group> a, hn::Vec<Group> b) const
        {
            return hn::Max(a, b);
        }
        HWY_INLINE float of_lanes(hn::Vec<Group> v) const { return hn::GetLane(hn::MaxOfLanes(Group(), v)); }
    };

    // Of each group's values the best, and of all of them.
    template <class Better>
    static HWY_INLINE float find_best(const float* values, float* of_groups, Better better)
    {
        const Group f;
        alignas(64) float of_halves[2 * RayFan::kGroups];
        static_assert(RayFan::kGroup == 2 * 4);
        for (unsigned i = 0; i < RayFan::kRays; i += 4 * kGroupLanes) {
            hn::Vec<Group> v[4];
            hn::LoadInterleaved4(f, values + i, v[0], v[1], v[2], v[3]);
            hn::Store(better(better(v[0], v[1]), better(v[2], v[3])), f, of_halves + i / 4);
        }
        hn::Vec<Group> best;
        for (unsigned g = 0; g < RayFan::kGroups; g += kGroupLanes) {
            hn::Vec<Group> first, second;
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
    }

    RayFan& fan_;
    const MeshView& mesh_;
    const Ray* rays_;
    unsigned count_;
    bool any_hit_ = false;
    Vec3d apex_;
    alignas(64) float first_half_[RayFan::kRays][4], second_half_[RayFan::kRays][4];
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
