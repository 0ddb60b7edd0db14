// prepare_run: rays made ready for the kernels, a vector of them at a time. Included by mesh_kernels.cpp, once a
// target.
#if defined(HELIOGRAPH_PREPARE_RUN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_PREPARE_RUN_INL
#undef HELIOGRAPH_PREPARE_RUN_INL
#else
#define HELIOGRAPH_PREPARE_RUN_INL
#endif

#include "renderer/accel/kernel_lanes-inl.h"
#include "renderer/accel/mesh_kernels.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

using Doubles = hn::CappedTag<double, RayRun::kRays>;
using Floats = hn::CappedTag<float, RayRun::kRays>;
inline constexpr unsigned kDoubles = hn::MaxLanes(Doubles()), kFloats = hn::MaxLanes(Floats());

// What the rays of a run have in common, or not: bit i tells of ray i.
struct RunKind {
    std::uint32_t x_over_y = 0, x_over_z = 0, y_over_z = 0; // of |direction|
    std::uint32_t negative[3] = {};
    std::uint32_t other_units = 0; // than those of the first

    bool alike(std::uint32_t rays) const
    {
        const auto uniform = [rays](std::uint32_t bits) {
            return (bits & rays) == 0 || (bits & rays) == rays;
        };
        return uniform(x_over_y) && uniform(x_over_z) && uniform(y_over_z) && uniform(negative[0]) &&
               uniform(negative[1]) && uniform(negative[2]) && (other_units & rays) == 0;
    }
};

// Vectors of rays that `count` rays fill; the last one is filled up with copies of the first ray.
HWY_INLINE unsigned load_rays(RayRun& run, const Ray* rays, unsigned count)
{
    const unsigned used = (count + kFloats - 1) / kFloats * kFloats;
    for (unsigned i = 0; i < used; ++i) {
        const Ray& ray = rays[i < count ? i : 0];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            run.origin[axis][i] = ray.origin[axis];
            run.direction[axis][i] = ray.direction[axis];
        }
        run.t_min[i] = ray.t_min;
        run.t_max[i] = ray.t_max;
    }
    run.rays = (1u << count) - 1;
    return used;
}

// The exact part of one vector of rays: i, i + 1, ...
class ExactLanes {
public:
    HWY_INLINE ExactLanes(RayRun& run, unsigned i) : run_(run), i_(i) {}

    HWY_INLINE void prepare(const MeshView& mesh, RunKind& kind)
    {
        load(kind);
        scale(static_cast<double>(mesh.scale), kind);
        clip(mesh.bounds, mesh.blur);
        shear();
    }

private:
    using D = Doubles;
    using V = hn::Vec<Doubles>;
    using M = hn::Mask<Doubles>;
    static constexpr std::uint32_t kAll = (1u << hn::MaxLanes(D())) - 1;

    HWY_INLINE void keep(M lanes) { run_.rays &= ~((~bits_of(D(), lanes) & kAll) << i_); }

    // Takes the rays; those that are not traceable leave the run.
    HWY_INLINE void load(RunKind& kind)
    {
        const D d;
        const auto infinity = hn::Set(d, std::numeric_limits<double>::infinity());
        t_min_ = hn::Load(d, run_.t_min + i_);
        t_max_ = hn::Load(d, run_.t_max + i_);
        V size[3];
        auto sound = hn::Lt(t_min_, t_max_);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin_[axis] = hn::Load(d, run_.origin[axis] + i_);
            along_[axis] = hn::Load(d, run_.direction[axis] + i_);
            size[axis] = hn::Abs(along_[axis]);
            sound = hn::And(sound,
                            hn::And(hn::Lt(hn::Abs(origin_[axis]), infinity), hn::Lt(size[axis], infinity)));
            // Of -0 as well: its reciprocal is negative.
            negative_[axis] = hn::Lt(hn::CopySign(hn::Set(d, 1.0), along_[axis]), hn::Zero(d));
            kind.negative[axis] |= bits_of(d, negative_[axis]) << i_;
        }
        largest_ = hn::Max(size[0], hn::Max(size[1], size[2]));
        keep(hn::And(sound, hn::Ge(largest_, hn::Set(d, std::numeric_limits<double>::min()))));
        const auto x_over_y = hn::Gt(size[0], size[1]), x_over_z = hn::Gt(size[0], size[2]),
                   y_over_z = hn::Gt(size[1], size[2]);
        kind.x_over_y |= bits_of(d, x_over_y) << i_;
        kind.x_over_z |= bits_of(d, x_over_z) << i_;
        kind.y_over_z |= bits_of(d, y_over_z) << i_;
        main_is_x_ = hn::And(x_over_y, x_over_z);
        main_is_y_ = hn::AndNot(x_over_y, y_over_z);
    }

    // To the kernel's units.
    HWY_INLINE void scale(double mesh_scale, RunKind& kind)
    {
        const D d;
        const hn::RebindToUnsigned<D> du;
        // The power of two with the exponent of the largest component, inverted.
        const auto exponent = hn::And(hn::BitCast(du, largest_), hn::Set(du, std::uint64_t{0x7ff} << 52));
        const auto power = hn::Max(hn::BitCast(d, hn::Sub(hn::Set(du, std::uint64_t{0x7fe} << 52), exponent)),
                                   hn::Set(d, std::numeric_limits<double>::min()));
        const auto by = hn::Set(d, mesh_scale);
        const auto units = hn::Div(by, power), ray_units = hn::Div(power, by);
        hn::Store(ray_units, d, run_.ray_units + i_);
        kind.other_units |= bits_of(d, hn::Ne(ray_units, hn::Set(d, run_.ray_units[0]))) << i_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin_[axis] = hn::Mul(origin_[axis], by);
            along_[axis] = hn::Mul(along_[axis], power);
            inverse_[axis] = hn::Div(hn::Set(d, 1.0), along_[axis]);
            hn::Store(origin_[axis], d, run_.origin[axis] + i_);
            hn::Store(along_[axis], d, run_.direction[axis] + i_);
        }
        t_min_ = hn::Mul(t_min_, units);
        t_max_ = hn::Mul(t_max_, units);
        hn::Store(t_min_, d, run_.t_min + i_);
        hn::Store(t_max_, d, run_.t_max + i_);
    }

    // Where the rays are inside the bounds; those that miss them leave the run.
    HWY_INLINE void clip(const Bounds3f& box, double mesh_blur)
    {
        const D d;
        // Where double itself may be off: origin, box and the test's own roundings.
        const auto farthest = hn::Max(hn::Abs(origin_[0]), hn::Max(hn::Abs(origin_[1]), hn::Abs(origin_[2])));
        const auto blur = hn::Mul(hn::Add(farthest, hn::Set(d, mesh_blur)), hn::Set(d, 0x1p-49));
        auto enters = t_min_, leaves = t_max_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto lower = hn::Sub(hn::Set(d, static_cast<double>(box.lower[axis])), blur);
            const auto upper = hn::Add(hn::Set(d, static_cast<double>(box.upper[axis])), blur);
            const auto near_plane = hn::IfThenElse(negative_[axis], upper, lower);
            const auto far_plane = hn::IfThenElse(negative_[axis], lower, upper);
            const auto enter = hn::Mul(hn::Sub(near_plane, origin_[axis]),
                                       hn::Mul(inverse_[axis], hn::Set(d, 1 - gamma<double>(8))));
            const auto leave = hn::Mul(hn::Sub(far_plane, origin_[axis]),
                                       hn::Mul(inverse_[axis], hn::Set(d, 1 + gamma<double>(8))));
            // A NaN (0 * infinity) says nothing.
            enters = hn::IfThenElse(hn::Gt(enter, enters), enter, enters);
            leaves = hn::IfThenElse(hn::Lt(leave, leaves), leave, leaves);
        }
        hn::Store(enters, d, run_.start + i_);
        hn::Store(blur, d, run_.blur + i_);
        keep(hn::Le(enters, leaves));
    }

    // As WatertightRay does, operation for operation.
    HWY_INLINE void shear()
    {
        const D d;
        const auto by_main = [&](V if_x, V if_y, V if_z) HWY_ATTR {
            return hn::IfThenElse(main_is_x_, if_x, hn::IfThenElse(main_is_y_, if_y, if_z));
        };
        const V main = by_main(along_[0], along_[1], along_[2]);
        const V first = by_main(along_[1], along_[2], along_[0]),
                second = by_main(along_[2], along_[0], along_[1]);
        const M turned = hn::Lt(main, hn::Zero(d));
        hn::Store(hn::Div(hn::IfThenElse(turned, second, first), main), d, run_.sx + i_);
        hn::Store(hn::Div(hn::IfThenElse(turned, first, second), main), d, run_.sy + i_);
        hn::Store(by_main(inverse_[0], inverse_[1], inverse_[2]), d, run_.sz + i_);
    }

    RayRun& run_;
    unsigned i_;
    V origin_[3], along_[3], inverse_[3], t_min_, t_max_, largest_;
    M negative_[3], main_is_x_, main_is_y_;
};

// The axes of ray i, as WatertightRay and the boxes name them.
HWY_INLINE void name_axes(RayRun& run, unsigned i, const RunKind& kind)
{
    const auto bit = [i](std::uint32_t bits) { return bits >> i & 1; };
    const std::uint32_t kz =
        bit(kind.x_over_y) != 0 ? (bit(kind.x_over_z) != 0 ? 0u : 2u) : (bit(kind.y_over_z) != 0 ? 1u : 2u);
    std::uint32_t kx = kz == 2 ? 0 : kz + 1, ky = kx == 2 ? 0 : kx + 1;
    if (bit(kind.negative[kz]) != 0) std::swap(kx, ky);
    run.kx[i] = static_cast<std::uint8_t>(kx);
    run.ky[i] = static_cast<std::uint8_t>(ky);
    run.kz[i] = static_cast<std::uint8_t>(kz);
    for (std::uint32_t axis = 0; axis < 3; ++axis)
        run.near_row[axis][i] = static_cast<std::uint8_t>(2 * axis + bit(kind.negative[axis]));
}

// The same axes for all rays.
HWY_INLINE void share_axes(RayRun& run, unsigned of)
{
    const auto share = [of](RayRun::Lanes<std::uint8_t>& lanes) {
        std::memset(lanes, lanes[of], sizeof lanes);
    };
    share(run.kx);
    share(run.ky);
    share(run.kz);
    for (auto& row : run.near_row)
        share(row);
}

// Lets all rays start where the first of them does; lanes without a ray become copies of one.
HWY_INLINE void start_together(RayRun& run, unsigned used)
{
    double first = std::numeric_limits<double>::infinity();
    unsigned one = 0;
    for (unsigned lanes = run.rays; lanes != 0; lanes &= lanes - 1) {
        one = static_cast<unsigned>(__builtin_ctz(lanes));
        first = std::min(first, run.start[one]);
    }
    for (unsigned i = 0; i < used; ++i) {
        run.start[i] = first;
        if ((run.rays >> i & 1) != 0) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            run.origin[axis][i] = run.origin[axis][one];
            run.direction[axis][i] = run.direction[axis][one];
        }
        run.blur[i] = run.blur[one];
    }
}

// As many doubles as a vector of floats has lanes, each rounded to nearest.
HWY_INLINE hn::Vec<Floats> narrow_lanes(Floats f, const double* from)
{
    alignas(64) float narrow[hn::MaxLanes(f)];
    for (std::size_t lane = 0; lane < hn::MaxLanes(f); ++lane)
        narrow[lane] = static_cast<float>(from[lane]);
    return hn::Load(f, narrow);
}

HWY_INLINE hn::Vec<Floats> narrow_difference(Floats f, const double* a, const double* b)
{
    const Doubles d;
    alignas(64) double difference[hn::MaxLanes(f)];
    for (std::size_t lane = 0; lane < hn::MaxLanes(f); lane += hn::MaxLanes(d))
        hn::Store(hn::Sub(hn::Load(d, a + lane), hn::Load(d, b + lane)), d, difference + lane);
    return narrow_lanes(f, difference);
}

HWY_INLINE hn::Vec<Floats> float_origin(Floats f, const RayRun& run, std::size_t axis, unsigned i)
{
    const Doubles d;
    alignas(64) double at[hn::MaxLanes(f)];
    for (std::size_t lane = 0; lane < hn::MaxLanes(f); lane += hn::MaxLanes(d))
        hn::Store(
            hn::Add(hn::Load(d, run.origin[axis] + i + lane),
                    hn::Mul(hn::Load(d, run.direction[axis] + i + lane), hn::Load(d, run.start + i + lane))),
            d,
            at + lane);
    return narrow_lanes(f, at);
}

// The float copies of rays i, i + 1, ... Products and sums of the box test may be fused or not: each rounding
// counts as a shift of the plane by less than a unit of |plane| or |from|, which `lateral` has room for; the
// reciprocal's own roundings are in the factors.
HWY_INLINE void narrow_rays(RayRun& run, unsigned i, const Bounds3f& box)
{
    const Floats f;
    const auto narrow = [&](const double* from) HWY_ATTR { return narrow_lanes(f, from + i); };
    const auto unit = hn::Set(f, 0x1p-24f);
    hn::Vec<Floats> from[3];
    auto reach = hn::Zero(f), farthest = hn::Zero(f);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        from[axis] = float_origin(f, run, axis, i);
        hn::Store(from[axis], f, run.from[axis] + i);
        reach = hn::Max(reach,
                        hn::Max(hn::Abs(hn::Sub(hn::Set(f, box.lower[axis]), from[axis])),
                                hn::Abs(hn::Sub(hn::Set(f, box.upper[axis]), from[axis]))));
        farthest = hn::Max(farthest, hn::Abs(from[axis]));
    }
    // How far to the side of the double ray anything computed from the copy may be.
    const auto lateral =
        hn::Add(hn::Mul(unit, hn::Add(hn::Mul(hn::Set(f, 8.0f), reach), hn::Mul(hn::Set(f, 4.0f), farthest))),
                hn::Mul(hn::Set(f, 2.0f), narrow(run.blur)));
    hn::Store(lateral, f, run.lateral + i);
    const auto along_slack = hn::Mul(hn::Set(f, 4.0f), lateral);
    hn::Store(hn::Neg(along_slack), f, run.begin + i);
    const auto last = narrow_difference(f, run.t_max + i, run.start + i); // as RayRun::end_for
    const auto rounded =
        hn::Add(hn::Mul(hn::Abs(last), hn::Set(f, 0x1p-23f)), hn::Set(f, std::numeric_limits<float>::min()));
    hn::Store(hn::Add(hn::Add(last, rounded), along_slack), f, run.end + i);
    hn::Store(narrow(run.sx), f, run.shear_x + i);
    hn::Store(narrow(run.sy), f, run.shear_y + i);
    hn::Store(narrow(run.sz), f, run.depth_scale + i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto along = narrow(run.direction[axis]);
        // Along an axis that a ray hardly moves on, a larger reciprocal would change nothing but give NaN.
        const auto size = hn::Min(hn::Abs(hn::Div(hn::Set(f, 1.0f), along)), hn::Set(f, 0x1p60f));
        const auto inverse = hn::CopySign(size, along);
        const auto pad = hn::CopySign(lateral, along);
        const auto nears = hn::Mul(inverse, hn::Set(f, 1 - gamma<float>(6)));
        const auto fars = hn::Mul(inverse, hn::Set(f, 1 + gamma<float>(6)));
        hn::Store(nears, f, run.near_scale[axis] + i);
        hn::Store(fars, f, run.far_scale[axis] + i);
        hn::Store(hn::Neg(hn::Mul(hn::Add(from[axis], pad), nears)), f, run.near_shift[axis] + i);
        hn::Store(hn::Neg(hn::Mul(hn::Sub(from[axis], pad), fars)), f, run.far_shift[axis] + i);
    }
}

// How rays are to be followed; only those that go together are made ready here.
enum class Following { none, together, apart };

HWY_INLINE Following prepare_run(RayRun& run, const MeshView& mesh, const Ray* rays, unsigned count)
{
    if (mesh.nodes == nullptr) return Following::none;
    RunKind kind;
    const unsigned used = load_rays(run, rays, count);
    for (unsigned i = 0; i < used; i += kDoubles)
        ExactLanes(run, i).prepare(mesh, kind);
    if (run.rays == 0) return Following::none;
    const bool together = used == RayRun::kRays && std::popcount(run.rays) >= 4 && kind.alike(run.rays);
    if (!together) return Following::apart;
    const auto any = static_cast<unsigned>(__builtin_ctz(run.rays));
    name_axes(run, any, kind);
    share_axes(run, any);
    start_together(run, used);
    for (unsigned i = 0; i < used; i += kFloats)
        narrow_rays(run, i, mesh.bounds);
    for (unsigned lanes = ~run.rays & ((1u << used) - 1); lanes != 0; lanes &= lanes - 1)
        run.end[__builtin_ctz(lanes)] = -std::numeric_limits<float>::infinity();
    return Following::together;
}

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
