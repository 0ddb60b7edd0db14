// FanSides: the boxes that rays of a fan may enter. Included by mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_FAN_SIDES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_FAN_SIDES_INL
#undef HELIOGRAPH_FAN_SIDES_INL
#else
#define HELIOGRAPH_FAN_SIDES_INL
#endif

#include "renderer/accel/prepare_fan-inl.h"

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// The four planes that bound all rays, and the depths between which any of them still runs. A box is beside
// plane `side` where its foremost corner is: rows of WideNode::planes say which corner that is.
class FanSides {
public:
    HWY_INLINE explicit FanSides(const RayFan& fan) : fan_(fan)
    {
        sign_ = fan.turned ? -1.0f : 1.0f;
        near_row_ = 2 * fan.z + (fan.turned ? 1 : 0);
        // Roundings of slopes, planes and of this test; lines beside the apex.
        const double size = max_abs(fan.apex) + static_cast<double>(fan.size);
        const double slack = size * 0x1p-20 + 4.0 * static_cast<double>(fan.aside);
        depth_shift_ = static_cast<float>(-fan.sign() * fan.apex.z - slack);
        begin_ = fan.all_begin - static_cast<float>(2 * slack);
        apex_x_ = static_cast<float>(fan.apex.x);
        apex_y_ = static_cast<float>(fan.apex.y);
        slack_ = static_cast<float>(slack);
        const auto set = [&](unsigned side, std::size_t row, float slope, double at, double by) {
            // The depth at which the box reaches farthest to this side's inner half.
            const bool far = side % 2 == 0 ? slope > 0 : slope < 0;
            Side& s = sides_[side];
            s.row = row;
            s.depth_row = far ? near_row_ ^ 1 : near_row_;
            s.slope = slope * sign_;
            s.at = static_cast<float>(at - static_cast<double>(s.slope) * fan.apex.z + by);
        };
        set(0, 2 * fan.x, fan.all_most_x, fan.apex.x, slack);
        set(1, 2 * fan.x + 1, fan.all_least_x, fan.apex.x, -slack);
        set(2, 2 * fan.y, fan.all_most_y, fan.apex.y, slack);
        set(3, 2 * fan.y + 1, fan.all_least_y, fan.apex.y, -slack);
    }

    HWY_INLINE float begin() const { return begin_; }

    // Children that some ray may enter before `end`, and the depths where.
    HWY_INLINE void enter_children(const WideNode& node, float end, Entered& out) const
    {
        const Eight d;
        const auto sign = hn::Set(d, sign_), shift = hn::Set(d, depth_shift_);
        out.children = 0;
        for (std::size_t lane = 0; lane < WideNode::kChildren; lane += hn::MaxLanes(d)) {
            const auto entry = hn::MulAdd(hn::Load(d, node.planes[near_row_] + lane), sign, shift);
            const auto exit = hn::MulAdd(hn::Load(d, node.planes[near_row_ ^ 1] + lane), sign, shift);
            auto in = hn::And(hn::Le(entry, hn::Set(d, end)), hn::Le(hn::Set(d, begin_), exit));
            for (unsigned side = 0; side < 4; ++side) {
                const Side& s = sides_[side];
                const auto at = hn::NegMulAdd(hn::Set(d, s.slope),
                                              hn::Load(d, node.planes[s.depth_row] + lane),
                                              hn::Load(d, node.planes[s.row] + lane));
                const auto limit = hn::Set(d, s.at);
                in = hn::And(in, side % 2 == 0 ? hn::Le(at, limit) : hn::Le(limit, at));
            }
            hn::Store(entry, d, out.entries + lane);
            out.children |= bits_of(d, in) << lane;
        }
    }

    // Bit g: the rays of group g may enter the child. These are closer bounds than those of all together.
    HWY_INLINE unsigned groups_entering(const WideNode& node, unsigned child) const
    {
        const Group f;
        const float near = std::max(node.planes[near_row_][child] * sign_ + depth_shift_, 0.0f);
        const float far = node.planes[near_row_ ^ 1][child] * sign_ + depth_shift_ + 2 * slack_;
        const auto reach_between =
            [&](const float* least, const float* most, float lower, float upper) HWY_ATTR {
                const auto a = hn::Set(f, near), b = hn::Set(f, far);
                const auto l = hn::Load(f, least), m = hn::Load(f, most);
                return hn::And(hn::Le(hn::Set(f, lower), hn::Max(hn::Mul(m, a), hn::Mul(m, b))),
                               hn::Le(hn::Min(hn::Mul(l, a), hn::Mul(l, b)), hn::Set(f, upper)));
            };
        unsigned groups = 0;
        for (unsigned g = 0; g < RayFan::kGroups; g += kGroupLanes) {
            const auto in_x = reach_between(fan_.least_x + g,
                                            fan_.most_x + g,
                                            node.planes[2 * fan_.x][child] - apex_x_ - slack_,
                                            node.planes[2 * fan_.x + 1][child] - apex_x_ + slack_);
            const auto in_y = reach_between(fan_.least_y + g,
                                            fan_.most_y + g,
                                            node.planes[2 * fan_.y][child] - apex_y_ - slack_,
                                            node.planes[2 * fan_.y + 1][child] - apex_y_ + slack_);
            const auto in_depth = hn::And(hn::Le(hn::Set(f, near), hn::Load(f, fan_.group_end + g)),
                                          hn::Le(hn::Load(f, fan_.group_begin + g), hn::Set(f, far)));
            groups |= bits_of(f, hn::And(in_depth, hn::And(in_x, in_y))) << g;
        }
        return groups;
    }

private:
    struct Side {
        std::size_t row, depth_row;
        float slope, at;
    };
    const RayFan& fan_;
    Side sides_[4]; // even: nothing beyond it; odd: nothing before it
    std::size_t near_row_;
    float sign_, depth_shift_, begin_;
    float apex_x_, apex_y_, slack_;
};

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
