// ShadowFans: rays of which any hit will do, as one fan or as a few. Included by mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_SHADOW_FANS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_SHADOW_FANS_INL
#undef HELIOGRAPH_SHADOW_FANS_INL
#else
#define HELIOGRAPH_SHADOW_FANS_INL
#endif

#include "renderer/accel/follow_fan-inl.h"
#include "renderer/math/uninitialized.h"

#include <algorithm>
#include <cstdint>
#include <span>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// The rays of a fan as they are seen from its apex, those next to each other together: where they are put in this order,
// groups are narrow though their neighbours among the pixels start on other things.
class SlopeOrder {
public:
    HWY_INLINE explicit SlopeOrder(const RayFan& fan) : fan_(fan) {}

    // Groups that bound more than one and a half times what all rays together do: 7 % of the fans in Sponza, 8 in the museum.
    HWY_INLINE bool is_needed() const
    {
        const Group f;
        auto of_groups = hn::Zero(f);
        for (unsigned g = 0; g < RayFan::kGroups; g += kGroupLanes) {
            const auto x = hn::Sub(hn::Load(f, fan_.most_x + g), hn::Load(f, fan_.least_x + g)),
                       y = hn::Sub(hn::Load(f, fan_.most_y + g), hn::Load(f, fan_.least_y + g));
            of_groups = hn::MulAdd(x, y, of_groups);
        }
        const float of_all = (fan_.all_most_x - fan_.all_least_x) * (fan_.all_most_y - fan_.all_least_y);
        return hn::GetLane(hn::SumOfLanes(f, of_groups)) > 1.5f * of_all;
    }

    // The numbers of its rays in this order: along a Z through 16 x 16 cells, by counting.
    HWY_INLINE void find(std::uint8_t (&order)[RayFan::kRays]) const
    {
        alignas(64) std::uint32_t cells[RayFan::kRays];
        find_cells(cells);
        constexpr unsigned kDigits = 1u << kBits;
        std::uint8_t low[kDigits] = {}, high[kDigits] = {};
        for (unsigned i = 0; i < fan_.count; ++i) {
            ++low[cells[i] % kDigits];
            ++high[cells[i] / kDigits];
        }
        add_up(low);
        add_up(high);
        std::uint8_t by_low[RayFan::kRays];
        for (unsigned i = 0; i < fan_.count; ++i)
            by_low[low[cells[i] % kDigits]++] = static_cast<std::uint8_t>(i);
        for (unsigned i = 0; i < fan_.count; ++i)
            order[high[cells[by_low[i]] / kDigits]++] = by_low[i];
    }

private:
    static constexpr unsigned kBits = 4; // a digit of a cell's number, and a coordinate of it

    static HWY_INLINE void add_up(std::uint8_t (&counts)[1u << kBits])
    {
        unsigned before = 0;
        for (std::uint8_t& count : counts) {
            const unsigned here = count;
            count = static_cast<std::uint8_t>(before);
            before += here;
        }
    }

    HWY_INLINE void find_cells(std::uint32_t* cells) const
    {
        const Group f;
        const hn::RebindToSigned<Group> i32;
        const hn::RebindToUnsigned<Group> u32;
        constexpr unsigned kLast = (1u << kBits) - 1;
        const auto along = [&](const float* slopes, float least, float most) HWY_ATTR {
            const float size = most - least;
            const auto at = hn::Mul(hn::Sub(hn::Load(f, slopes), hn::Set(f, least)),
                                    hn::Set(f, size > 0 ? static_cast<float>(kLast + 1) / size : 0.0f));
            const auto cell =
                hn::BitCast(u32, hn::ConvertTo(i32, hn::Min(at, hn::Set(f, static_cast<float>(kLast)))));
            const auto pairs = hn::And(hn::Or(cell, hn::ShiftLeft<2>(cell)), hn::Set(u32, 0x33u));
            return hn::And(hn::Or(pairs, hn::ShiftLeft<1>(pairs)), hn::Set(u32, 0x55u));
        };
        for (unsigned i = 0; i < fan_.groups() * RayFan::kGroup; i += kGroupLanes) {
            const auto x = along(fan_.slope_x + i, fan_.all_least_x, fan_.all_most_x);
            const auto y = along(fan_.slope_y + i, fan_.all_least_y, fan_.all_most_y);
            hn::Store(hn::Or(x, hn::ShiftLeft<1>(y)), u32, cells + i);
        }
    }

    const RayFan& fan_;
};

class ShadowFans {
public:
    ShadowFans(const MeshView& mesh, const Ray* rays, unsigned count, MeshHit* room)
        : mesh_(mesh), rays_(rays), count_(count), room_(room)
    {
    }

    // False: nothing has been found, and the rays are to be followed in another way.
    bool follow() { return follow_fan(rays_, nullptr, count_) || follow_by_faces(); }

    // Bit i: ray i hit.
    std::uint64_t found() const { return found_; }
    // Rays of which fans have told nothing, and which they are.
    std::span<const Ray> left() { return left_.first(left_count_); }
    void found_of_left(std::uint64_t met)
    {
        for (; met != 0; met &= met - 1)
            found_ |= std::uint64_t{1} << number_of_left_[__builtin_ctzll(met)];
    }

private:
    // Which of all rays some are; where they are all, in their own order, none are kept.
    using Numbers = std::uint8_t[RayFan::kRays];
    static HWY_INLINE std::uint8_t number_of(const std::uint8_t* numbers, unsigned ray)
    {
        return numbers == nullptr ? static_cast<std::uint8_t>(ray) : numbers[ray];
    }

    // Rays that end at one point and come from two or three sides of it, a fan a side. From more sides they have little
    // in common, and from one side alone it is something else that keeps them from being a fan.
    bool follow_by_faces()
    {
        constexpr unsigned kFaces = 6;
        if (count_ < kFewestOfFan) return false;
        const Vec3d apex = end_of(rays_[0]);
        std::uint64_t on_face[kFaces] = {};
        for (unsigned i = 0; i < count_; ++i) {
            const Ray& ray = rays_[i];
            if (!ends_near(ray, apex)) return false;
            const Vec3d size = abs(ray.direction);
            const std::size_t axis = main_axis(size);
            on_face[2 * axis + (ray.direction[axis] < 0 ? 1 : 0)] |= std::uint64_t{1} << i;
        }
        const auto faces = std::ranges::count_if(on_face, [](std::uint64_t rays) { return rays != 0; });
        if (faces < 2 || faces > 3) return false;
        for (const std::uint64_t face : on_face) {
            Uninitialized<Ray, RayFan::kRays> rays;
            Numbers numbers;
            unsigned count = 0;
            for (std::uint64_t some = face; some != 0; some &= some - 1) {
                numbers[count] = static_cast<std::uint8_t>(__builtin_ctzll(some));
                rays[count] = rays_[numbers[count]];
                ++count;
            }
            if (count != 0 && !follow_fan(rays.data(), numbers, count))
                for (unsigned i = 0; i < count; ++i)
                    leave(rays[i], numbers[i]);
        }
        return true;
    }

    bool follow_fan(const Ray* rays, const std::uint8_t* numbers, unsigned count)
    {
        RayFan fan;
        if (!prepare_fan(fan, mesh_, rays, count, true)) return false;
        const SlopeOrder order(fan);
        if (!order.is_needed()) {
            walk(fan, rays, numbers);
            return true;
        }
        Numbers by_slope, sorted_numbers;
        order.find(by_slope);
        Uninitialized<Ray, RayFan::kRays> sorted;
        for (unsigned i = 0; i < count; ++i) {
            sorted[i] = rays[by_slope[i]];
            sorted_numbers[i] = number_of(numbers, by_slope[i]);
        }
        if (!prepare_fan(fan, mesh_, sorted.data(), count, true)) return false;
        walk(fan, sorted.data(), sorted_numbers);
        return true;
    }

    void walk(RayFan& fan, const Ray* rays, const std::uint8_t* numbers)
    {
        FanWalk<true> fan_walk(mesh_, fan, rays, room_);
        const std::uint64_t met = fan_walk.walk();
        if (mesh_.fans != nullptr) mesh_.fans->any.tell(!fan_walk.gave_up());
        if (numbers == nullptr)
            found_ = met;
        else
            for (std::uint64_t hits = met; hits != 0; hits &= hits - 1)
                found_ |= std::uint64_t{1} << numbers[__builtin_ctzll(hits)];
        if (!fan_walk.has_left_some()) return;
        for (unsigned i = 0; i < fan.count; ++i)
            if ((met >> i & 1) == 0) leave(rays[i], number_of(numbers, i));
    }

    void leave(const Ray& ray, std::uint8_t number)
    {
        left_[left_count_] = ray;
        number_of_left_[left_count_++] = number;
    }

    const MeshView& mesh_;
    const Ray* rays_;
    unsigned count_;
    MeshHit* room_;
    std::uint64_t found_ = 0;
    unsigned left_count_ = 0;
    Uninitialized<Ray, RayFan::kRays> left_;
    Numbers number_of_left_;
};

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
