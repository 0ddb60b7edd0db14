// enter_box: which rays of a run are inside a box of the upper level. Included by mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_ENTER_BOX_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_ENTER_BOX_INL
#undef HELIOGRAPH_ENTER_BOX_INL
#else
#define HELIOGRAPH_ENTER_BOX_INL
#endif

#include "renderer/accel/box_rays.h"
#include "renderer/accel/kernel_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// As SlabRay::meets, operation for operation.
inline std::uint64_t enter_box(const BoxRays& rays, const Vec3d& lower, const Vec3d& upper, double& nearest)
{
    const hn::CappedTag<double, BoxRays::kStep> d;
    std::uint64_t inside = 0;
    auto least = hn::Set(d, std::numeric_limits<double>::infinity());
    for (unsigned i = 0; i < rays.lanes; i += static_cast<unsigned>(hn::MaxLanes(d))) {
        auto entry = hn::Load(d, rays.begin + i), exit = hn::Load(d, rays.end + i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto near_inverse = hn::Load(d, rays.near_inverse[axis] + i);
            const auto low = hn::Set(d, lower[axis]), high = hn::Set(d, upper[axis]);
            const auto negative = hn::Lt(hn::CopySign(hn::Set(d, 1.0), near_inverse), hn::Zero(d));
            const auto t_near =
                hn::Mul(hn::Sub(hn::IfThenElse(negative, high, low), hn::Load(d, rays.near_origin[axis] + i)),
                        near_inverse);
            const auto t_far =
                hn::Mul(hn::Sub(hn::IfThenElse(negative, low, high), hn::Load(d, rays.far_origin[axis] + i)),
                        hn::Load(d, rays.far_inverse[axis] + i));
            // A NaN (0 * infinity) says nothing.
            entry = hn::IfThenElse(hn::Gt(t_near, entry), t_near, entry);
            exit = hn::IfThenElse(hn::Lt(t_far, exit), t_far, exit);
        }
        const auto met = hn::Le(entry, exit);
        inside |= std::uint64_t{bits_of(d, met)} << i;
        least = hn::Min(least, hn::IfThenElse(met, entry, least));
    }
    nearest = hn::GetLane(hn::MinOfLanes(d, least));
    return inside;
}

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
