// prepare_apart: rays that have nothing in common, made ready for the kernels: only what the walk in float needs,
// a vector of them at a time. Included by mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_PREPARE_APART_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_PREPARE_APART_INL
#undef HELIOGRAPH_PREPARE_APART_INL
#else
#define HELIOGRAPH_PREPARE_APART_INL
#endif

#include "renderer/accel/kernel_lanes-inl.h"
#include "renderer/accel/lone_rays.h"
#include "renderer/accel/mesh_kernels.h"
#include "renderer/geometry/rounding.h"

#include <algorithm>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// Rays i, i + 1, ...: a vector of them; what is behind `count` is a copy of the first.
class LoneLanes {
public:
    HWY_INLINE LoneLanes(LoneRays& run, unsigned i) : run_(run), i_(i) {}

    HWY_INLINE void prepare(const MeshView& mesh, const Ray* rays, unsigned count)
    {
        load(rays, count);
        scale(static_cast<double>(mesh.scale));
        clip(mesh.bounds, mesh.blur);
        name_axes();
        narrow(mesh.bounds);
        run_.rays |= std::uint64_t{bits_of(D(), sound_)} << i_;
    }

private:
    using D = hn::CappedTag<double, 8>;
    using F = hn::Rebind<float, D>;
    using V = hn::Vec<D>;
    using M = hn::Mask<D>;
    using Vf = hn::Vec<F>;

public:
    static constexpr unsigned kLanes = hn::MaxLanes(D());

private:
    // Takes the rays, and tells those that are traceable.
    HWY_INLINE void load(const Ray* rays, unsigned count)
    {
        const D d;
        alignas(64) double origin[3][kLanes], along[3][kLanes], t_min[kLanes], t_max[kLanes];
        for (unsigned lane = 0; lane < kLanes; ++lane) {
            const Ray& ray = rays[i_ + lane < count ? i_ + lane : 0];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                origin[axis][lane] = ray.origin[axis];
                along[axis][lane] = ray.direction[axis];
            }
            t_min[lane] = ray.t_min;
            t_max[lane] = ray.t_max;
        }
        const auto infinity = hn::Set(d, std::numeric_limits<double>::infinity());
        t_min_ = hn::Load(d, t_min);
        t_max_ = hn::Load(d, t_max);
        sound_ = hn::Lt(t_min_, t_max_);
        V size[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin_[axis] = hn::Load(d, origin[axis]);
            along_[axis] = hn::Load(d, along[axis]);
            size[axis] = hn::Abs(along_[axis]);
            sound_ = hn::And(sound_,
                             hn::And(hn::Lt(hn::Abs(origin_[axis]), infinity), hn::Lt(size[axis], infinity)));
            // Of -0 as well: its reciprocal is negative.
            negative_[axis] = hn::Lt(hn::CopySign(hn::Set(d, 1.0), along_[axis]), hn::Zero(d));
        }
        largest_ = hn::Max(size[0], hn::Max(size[1], size[2]));
        sound_ = hn::And(sound_, hn::Ge(largest_, hn::Set(d, std::numeric_limits<double>::min())));
        // WatertightRay's main axis.
        main_is_x_ = hn::And(hn::Gt(size[0], size[1]), hn::Gt(size[0], size[2]));
        main_is_y_ = hn::AndNot(hn::Gt(size[0], size[1]), hn::Gt(size[1], size[2]));
    }

    // To the kernel's units.
    HWY_INLINE void scale(double mesh_scale)
    {
        const D d;
        const hn::RebindToUnsigned<D> du;
        // The power of two with the exponent of the largest component, inverted.
        const auto exponent = hn::And(hn::BitCast(du, largest_), hn::Set(du, std::uint64_t{0x7ff} << 52));
        const auto power = hn::Max(hn::BitCast(d, hn::Sub(hn::Set(du, std::uint64_t{0x7fe} << 52), exponent)),
                                   hn::Set(d, std::numeric_limits<double>::min()));
        const auto by = hn::Set(d, mesh_scale), one = hn::Set(d, 1.0);
        const auto units = hn::Div(by, power);
        hn::Store(power, d, run_.power + i_);
        hn::Store(units, d, run_.units + i_);
        hn::Store(hn::Div(power, by), d, run_.ray_units + i_);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin_[axis] = hn::Mul(origin_[axis], by);
            along_[axis] = hn::Mul(along_[axis], power);
            inverse_[axis] = hn::Div(one, along_[axis]);
        }
        t_min_ = hn::Mul(t_min_, units);
        t_max_ = hn::Mul(t_max_, units);
    }

    // Where the rays are inside the bounds; those that miss them are none.
    HWY_INLINE void clip(const Bounds3f& box, double mesh_blur)
    {
        const D d;
        // Where double itself may be off: origin, box and the test's own roundings.
        const auto farthest = hn::Max(hn::Abs(origin_[0]), hn::Max(hn::Abs(origin_[1]), hn::Abs(origin_[2])));
        blur_ = hn::Mul(hn::Add(farthest, hn::Set(d, mesh_blur)), hn::Set(d, 0x1p-49));
        start_ = t_min_;
        auto leaves = t_max_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto lower = hn::Sub(hn::Set(d, static_cast<double>(box.lower[axis])), blur_);
            const auto upper = hn::Add(hn::Set(d, static_cast<double>(box.upper[axis])), blur_);
            const auto near_plane = hn::IfThenElse(negative_[axis], upper, lower);
            const auto far_plane = hn::IfThenElse(negative_[axis], lower, upper);
            const auto enter = hn::Mul(hn::Sub(near_plane, origin_[axis]),
                                       hn::Mul(inverse_[axis], hn::Set(d, 1 - gamma<double>(8))));
            const auto leave = hn::Mul(hn::Sub(far_plane, origin_[axis]),
                                       hn::Mul(inverse_[axis], hn::Set(d, 1 + gamma<double>(8))));
            // A NaN (0 * infinity) says nothing.
            start_ = hn::IfThenElse(hn::Gt(enter, start_), enter, start_);
            leaves = hn::IfThenElse(hn::Lt(leave, leaves), leave, leaves);
        }
        sound_ = hn::And(sound_, hn::Le(start_, leaves));
        hn::Store(start_, d, run_.start + i_);
    }

    HWY_INLINE void name_axes()
    {
        static constexpr LoneRays::Axes kAxes[3][2]{
            {{16, 32, 0}, {32, 16, 0}}, {{32, 0, 16}, {0, 32, 16}}, {{0, 16, 32}, {16, 0, 32}}};
        const D d;
        const std::uint32_t negative[3] = {
            bits_of(d, negative_[0]), bits_of(d, negative_[1]), bits_of(d, negative_[2])};
        const std::uint32_t main_is_x = bits_of(d, main_is_x_), main_is_y = bits_of(d, main_is_y_);
        for (unsigned lane = 0; lane < kLanes; ++lane) {
            std::uint32_t bits[3];
            for (std::uint32_t axis = 0; axis < 3; ++axis) {
                bits[axis] = negative[axis] >> lane & 1;
                run_.near_row[axis][i_ + lane] = (2 * axis + bits[axis]) * 32;
            }
            // x, y or z: 0, 1 or 2
            const std::uint32_t main = 2 - 2 * (main_is_x >> lane & 1) - (main_is_y >> lane & 1);
            run_.axes[i_ + lane] = kAxes[main][bits[main]];
        }
    }

    // As WatertightRay renames x, y and z, `turned` set apart.
    HWY_INLINE V by_main(V if_x, V if_y, V if_z) const
    {
        return hn::IfThenElse(main_is_x_, if_x, hn::IfThenElse(main_is_y_, if_y, if_z));
    }

    // The float copies. Products and sums of the box test may be fused or not: each rounding counts as a shift of
    // the plane by less than a unit of |plane| or |from|, which `lateral` has room for; the reciprocal's own
    // roundings are in the factor that the walk compares with.
    HWY_INLINE void narrow(const Bounds3f& box)
    {
        const D d;
        const F f;
        const auto to_float = [&](V v) HWY_ATTR { return hn::DemoteTo(f, v); };
        V at[3];
        Vf from[3];
        auto reach = hn::Zero(f), farthest = hn::Zero(f);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at[axis] = hn::Add(origin_[axis], hn::Mul(along_[axis], start_));
            from[axis] = to_float(at[axis]);
            reach = hn::Max(reach,
                            hn::Max(hn::Abs(hn::Sub(hn::Set(f, box.lower[axis]), from[axis])),
                                    hn::Abs(hn::Sub(hn::Set(f, box.upper[axis]), from[axis]))));
            farthest = hn::Max(farthest, hn::Abs(from[axis]));
        }
        // How far to the side of the double ray anything computed from the copy may be.
        const auto lateral =
            hn::Add(hn::Mul(hn::Set(f, 0x1p-24f),
                            hn::Add(hn::Mul(hn::Set(f, 8.0f), reach), hn::Mul(hn::Set(f, 4.0f), farthest))),
                    hn::Mul(hn::Set(f, 2.0f), to_float(blur_)));
        hn::Store(lateral, f, run_.lateral + i_);
        // The same where only the start's own rounding and blur count.
        hn::Store(hn::MulAdd(hn::Set(f, 0x1p-23f), farthest, hn::Mul(hn::Set(f, 2.0f), to_float(blur_))),
                  f,
                  run_.near_lateral + i_);
        hn::Store(hn::Mul(hn::Set(f, -5.0f), lateral), f, run_.begin + i_);
        const auto last = to_float(hn::Sub(t_max_, start_));
        const auto rounded = hn::Add(hn::Mul(hn::Abs(last), hn::Set(f, 0x1p-23f)),
                                     hn::Set(f, std::numeric_limits<float>::min()));
        hn::Store(hn::Add(hn::Add(last, rounded), hn::Mul(hn::Set(f, 4.0f), lateral)),
                  f,
                  run_.end + i_); // as end_for
        hn::Store(hn::Sub(hn::Mul(last, hn::Set(f, 1 - 0x1p-22f)), hn::Mul(hn::Set(f, 6.0f), lateral)),
                  f,
                  run_.limit + i_);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto along = to_float(along_[axis]);
            // Along an axis that a ray hardly moves on, a larger reciprocal would change nothing but give NaN.
            const auto size = hn::Min(hn::Abs(to_float(inverse_[axis])), hn::Set(f, 0x1p60f));
            const auto inverse = hn::CopySign(size, along);
            const auto pad = hn::CopySign(lateral, along);
            hn::Store(inverse, f, run_.inverse[axis] + i_);
            hn::Store(hn::Neg(hn::Mul(hn::Add(from[axis], pad), inverse)), f, run_.near_shift[axis] + i_);
            hn::Store(hn::Neg(hn::Mul(hn::Sub(from[axis], pad), inverse)), f, run_.far_shift[axis] + i_);
        }
        const V main = by_main(along_[0], along_[1], along_[2]),
                inverse = by_main(inverse_[0], inverse_[1], inverse_[2]);
        const M turned = hn::Lt(main, hn::Zero(d));
        const auto store_pair = [&](V first, V second, float* x, float* y) HWY_ATTR {
            hn::Store(to_float(hn::IfThenElse(turned, second, first)), f, x + i_);
            hn::Store(to_float(hn::IfThenElse(turned, first, second)), f, y + i_);
        };
        store_pair(by_main(at[1], at[2], at[0]), by_main(at[2], at[0], at[1]), run_.from_x, run_.from_y);
        hn::Store(to_float(by_main(at[0], at[1], at[2])), f, run_.from_z + i_);
        store_pair(hn::Mul(by_main(along_[1], along_[2], along_[0]), inverse),
                   hn::Mul(by_main(along_[2], along_[0], along_[1]), inverse),
                   run_.shear_x,
                   run_.shear_y);
        hn::Store(to_float(inverse), f, run_.depth_scale + i_);
    }

    LoneRays& run_;
    unsigned i_;
    V origin_[3], along_[3], inverse_[3], t_min_, t_max_, largest_, blur_, start_;
    M sound_, negative_[3], main_is_x_, main_is_y_;
};

HWY_INLINE void prepare_apart(LoneRays& run, const MeshView& mesh, const Ray* rays, unsigned count)
{
    for (unsigned i = 0; i < count; i += LoneLanes::kLanes)
        LoneLanes(run, i).prepare(mesh, rays, count);
    run.rays &= ~std::uint64_t{0} >> (LoneRays::kRays - count);
}

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
