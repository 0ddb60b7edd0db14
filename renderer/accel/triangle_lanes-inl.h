// TriangleLanes: the watertight test in double, a vector of rays at a time, each against a triangle of its own. Included by
// mesh_kernels.cpp, once a target.
//
// As intersect_watertight does, operation for operation, so that the bits are the same; what is special is told and left to that.
#if defined(HELIOGRAPH_TRIANGLE_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_TRIANGLE_LANES_INL
#undef HELIOGRAPH_TRIANGLE_LANES_INL
#else
#define HELIOGRAPH_TRIANGLE_LANES_INL
#endif

#include "renderer/accel/kernel_lanes-inl.h"
#include "renderer/geometry/rounding.h"

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

class TriangleLanes {
public:
    using D = hn::CappedTag<double, 8>;
    using V = hn::Vec<D>;
    using M = hn::Mask<D>;
    static constexpr unsigned kLanes = hn::MaxLanes(D());

    // Axes renamed as WatertightRay does, directions brought to a length near 1; corner(k, axis): of the triangles.
    template <class Corner>
    HWY_INLINE TriangleLanes(const V (&origin)[3], const V (&direction)[3], Corner&& corner)
    {
        const D d;
        sx_ = hn::Div(direction[0], direction[2]);
        sy_ = hn::Div(direction[1], direction[2]);
        const V sz = hn::Div(hn::Set(d, 1.0), direction[2]);
        for (std::size_t k = 0; k < 3; ++k) {
            depth_[k] = hn::Sub(corner(k, 2), origin[2]);
            x_[k] = hn::Sub(hn::Sub(corner(k, 0), origin[0]), hn::Mul(sx_, depth_[k]));
            y_[k] = hn::Sub(hn::Sub(corner(k, 1), origin[1]), hn::Mul(sy_, depth_[k]));
            z_[k] = hn::Mul(sz, depth_[k]);
        }
        e_[0] = edge(1, 2);
        e_[1] = edge(2, 0);
        e_[2] = edge(0, 1);
        inverse_det_ = hn::Div(hn::Set(d, 1.0), hn::Add(hn::Add(e_[0], e_[1]), e_[2]));
        for (std::size_t k = 0; k < 3; ++k)
            weights_[k] = hn::Mul(e_[k], inverse_det_);
        t_ = mean(z_);
    }

    HWY_INLINE V t() const { return t_; }
    HWY_INLINE V weight(std::size_t k) const { return weights_[k]; }

    // They pass the triangle by.
    HWY_INLINE M beside() const
    {
        const V zero = hn::Zero(D());
        const M negative = hn::Or(hn::Or(hn::Lt(e_[0], zero), hn::Lt(e_[1], zero)), hn::Lt(e_[2], zero));
        const M positive = hn::Or(hn::Or(hn::Gt(e_[0], zero), hn::Gt(e_[1], zero)), hn::Gt(e_[2], zero));
        return hn::And(negative, positive);
    }

    // Within the triangle, and t and weights are what the test makes them: no edge at 0, which is looked at once more by its
    // exact products, and no weights that have to be drawn onto the ray.
    HWY_INLINE M is_plain() const
    {
        const D d;
        const V off = hn::Max(hn::Abs(mean(x_)), hn::Abs(mean(y_)));
        const V widest = hn::Max(max3(x_), max3(y_));
        return hn::And(hn::Le(off, hn::Mul(hn::Set(d, gamma<double>(16)), widest)),
                       hn::Gt(hn::Min(weights_[0], hn::Min(weights_[1], weights_[2])), hn::Zero(d)));
    }

    // WatertightRay names the axes so too: the third is the one that the ray runs along. Of two alike it takes either.
    HWY_INLINE M runs_along_third() const
    {
        const V one = hn::Set(D(), 1.0);
        return hn::And(hn::Lt(hn::Abs(sx_), one), hn::Lt(hn::Abs(sy_), one));
    }

    // The least that the true t can be: watertight::lower_bound_of_t.
    HWY_INLINE V lower_bound_of_t() const
    {
        const auto times = [](double a, V b) HWY_ATTR { return hn::Mul(hn::Set(D(), a), b); };
        const V max_z = max3(z_), depth = max3(depth_), max_x = max3(x_), max_y = max3(y_), max_e = max3(e_);
        const V delta_x = times(gamma<double>(5), hn::Add(max_x, depth));
        const V delta_y = times(gamma<double>(5), hn::Add(max_y, depth));
        const V delta_z = times(gamma<double>(3), max_z);
        const V delta_e =
            times(2,
                  hn::Add(hn::Add(hn::Mul(times(gamma<double>(2), max_x), max_y), hn::Mul(delta_y, max_x)),
                          hn::Mul(delta_x, max_y)));
        const V sum =
            hn::Add(hn::Add(hn::Mul(times(gamma<double>(3), max_e), max_z), hn::Mul(delta_e, max_z)),
                    hn::Mul(delta_z, max_e));
        const V delta_t = hn::Mul(times(3, sum), hn::Abs(inverse_det_));
        const V least = hn::Sub(hn::Min(hn::Min(z_[0], z_[1]), z_[2]), delta_z);
        return hn::Max(hn::Sub(t_, delta_t), least);
    }

private:
    HWY_INLINE V edge(std::size_t a, std::size_t b) const
    {
        return hn::Sub(hn::Mul(x_[b], y_[a]), hn::Mul(y_[b], x_[a]));
    }
    HWY_INLINE V mean(const V (&of)[3]) const
    {
        return hn::Add(hn::Add(hn::Mul(weights_[0], of[0]), hn::Mul(weights_[1], of[1])),
                       hn::Mul(weights_[2], of[2]));
    }
    static HWY_INLINE V max3(const V (&of)[3])
    {
        return hn::Max(hn::Max(hn::Abs(of[0]), hn::Abs(of[1])), hn::Abs(of[2]));
    }

    V sx_, sy_;
    V x_[3], y_[3], z_[3], depth_[3]; // of the corners, in the rays' frames
    V e_[3], inverse_det_, weights_[3], t_;
};

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
