#include "renderer/lights/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace renderer {

namespace {

double sine_of(double cosine)
{
    return std::sqrt(std::max(0.0, 1 - cosine * cosine));
}

// The smallest cone around both, as a bound: its axis is between the two.
void join_cones(LightBounds& all, const LightBounds& more)
{
    if (all.cos_spread <= -1 || more.cos_spread <= -1) {
        all.cos_spread = -1;
        return;
    }
    const Vec3d between = all.axis + more.axis;
    if (!(length(between) > 1e-6)) {
        all.cos_spread = -1;
        return;
    }
    const Vec3d axis = normalize(between);
    // cos of (angle to a cone's axis + its spread); beyond half a turn it is every way.
    const auto reach = [&](const LightBounds& cone) {
        const double c = std::clamp(dot(axis, cone.axis), -1.0, 1.0);
        if (c <= -cone.cos_spread) return -1.0;
        return std::max(-1.0, c * cone.cos_spread - sine_of(c) * sine_of(cone.cos_spread));
    };
    const double spread = std::min(reach(all), reach(more));
    all.axis = axis;
    all.cos_spread = spread;
}

void join(LightBounds& all, const LightBounds& more)
{
    all.box.extend(more.box);
    all.power += more.power;
    join_cones(all, more);
}

double surface(const Bounds3d& box)
{
    const Vec3d e = box.extent();
    return e.x * e.y + e.y * e.z + e.z * e.x;
}

// Cost of a node in the surface area orientation heuristic, with a simple measure of its cone.
double cost(const LightBounds& b)
{
    return b.power * (surface(b.box) + 1e-300) * (2 - std::max(-1.0, b.cos_spread));
}

// Lights whose centres lie in one slice of a node.
struct Bin {
    LightBounds bounds;
    std::size_t count = 0;

    void add(const LightBounds& more, std::size_t lights)
    {
        if (lights == 0) return;
        if (count == 0)
            bounds = more;
        else
            join(bounds, more);
        count += lights;
    }
};

Bin sum_of(std::span<const Bin> bins)
{
    Bin sum;
    for (const Bin& bin : bins)
        sum.add(bin.bounds, bin.count);
    return sum;
}

// How many bins go to the first child; 0: there is no cut that parts them.
std::size_t cheapest_cut(std::span<const Bin> bins)
{
    std::size_t best = 0;
    double best_cost = std::numeric_limits<double>::infinity();
    for (std::size_t at = 1; at < bins.size(); ++at) {
        const Bin low = sum_of(bins.first(at)), high = sum_of(bins.subspan(at));
        if (low.count == 0 || high.count == 0) continue;
        const double sum = cost(low.bounds) + cost(high.bounds);
        if (sum < best_cost) {
            best_cost = sum;
            best = at;
        }
    }
    return best;
}

// Puts those of the first child first, and tells how many they are: by twelve bins on the longest axis of the centres;
// where they are all in one place, halves.
std::size_t cut(std::span<std::uint32_t> lights, std::span<const LightBounds> all, const Bounds3d& centers)
{
    constexpr std::size_t kBins = 12;
    const Vec3d extent = centers.extent();
    const std::size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    if (!(extent[axis] > 0)) return lights.size() / 2;
    const auto bin_of = [&](std::uint32_t light) {
        const double place = (all[light].box.center()[axis] - centers.lower[axis]) / extent[axis];
        return std::min(kBins - 1, static_cast<std::size_t>(place * static_cast<double>(kBins)));
    };
    std::array<Bin, kBins> bins;
    for (const std::uint32_t light : lights)
        bins[bin_of(light)].add(all[light], 1);
    const std::size_t best = cheapest_cut(bins);
    if (best == 0) return lights.size() / 2;
    const auto border = std::stable_partition(
        lights.begin(), lights.end(), [&](std::uint32_t light) { return bin_of(light) < best; });
    return static_cast<std::size_t>(border - lights.begin());
}

} // namespace

double importance(const LightBounds& light, Vec3d point)
{
    const Vec3d from_light = point - light.box.center(), half = light.box.extent() / 2.0;
    const double distance2 = dot(from_light, from_light), radius2 = dot(half, half);
    if (!(distance2 > radius2))
        return radius2 > 0 ? light.power / radius2 : light.power / std::max(distance2, 1e-290);
    double facing = 1;
    if (light.cos_spread > -1) {
        // The least angle at which any of its normals may look at the point: to the axis, less the spread, less
        // what the box covers.
        const double cosine = dot(from_light, light.axis) / std::sqrt(distance2);
        const double sine_box = std::sqrt(radius2 / distance2),
                     cosine_box = std::sqrt(1 - radius2 / distance2);
        const double sine_spread = sine_of(light.cos_spread);
        double c = light.cos_spread * cosine_box - sine_spread * sine_box; // of spread and box together
        const double s = sine_spread * cosine_box + light.cos_spread * sine_box;
        if (s < 0 || c <= -1)
            facing = 1; // half a turn or more
        else
            facing = cosine >= c ? 1 : cosine * c + sine_of(cosine) * s;
        if (!(facing > 0)) return 0;
    }
    return light.power * facing / distance2;
}

LightTree::LightTree(std::span<const LightBounds> lights) : leaf_of_(lights.size(), kNoLeaf)
{
    std::vector<std::uint32_t> shining;
    for (std::uint32_t i = 0; i < lights.size(); ++i)
        if (lights[i].power > 0) shining.push_back(i);
    if (shining.empty()) return;
    nodes_.reserve(2 * shining.size() - 1);
    build(shining, lights, 0);
}

std::uint32_t
LightTree::build(std::span<std::uint32_t> lights, std::span<const LightBounds> all, std::uint32_t parent)
{
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    LightBounds bounds = all[lights[0]];
    Bounds3d centers;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (i != 0) join(bounds, all[lights[i]]);
        centers.extend(all[lights[i]].box.center());
    }
    nodes_.push_back({bounds, parent, 0, lights[0]});
    if (lights.size() == 1) {
        leaf_of_[lights[0]] = number;
        return number;
    }
    const std::size_t middle = cut(lights, all, centers);
    build(lights.first(middle), all, number);
    const std::uint32_t second = build(lights.subspan(middle), all, number);
    nodes_[number].second_child = second;
    return number;
}

// Chance of a node's first child; negative: of neither.
double LightTree::share_of_first(Vec3d point, std::uint32_t node) const
{
    const double first = importance(nodes_[node + 1].bounds, point),
                 second = importance(nodes_[nodes_[node].second_child].bounds, point);
    const double sum = first + second;
    if (!(sum > 0)) return -1;
    return std::isfinite(sum) ? first / sum : 0.5;
}

LightTree::Pick LightTree::pick(Vec3d point, double u) const
{
    if (nodes_.empty()) return {};
    std::uint32_t at = 0;
    double probability = 1;
    while (nodes_[at].second_child != 0) {
        const double share = share_of_first(point, at);
        if (share < 0) return {};
        if (u < share) {
            u /= share;
            probability *= share;
            ++at;
        } else {
            u = (u - share) / (1 - share);
            probability *= 1 - share;
            at = nodes_[at].second_child;
        }
        u = std::min(u, 0x1.fffffffffffffp-1);
    }
    return {nodes_[at].light, probability};
}

double LightTree::probability(Vec3d point, std::uint32_t light) const
{
    if (light >= leaf_of_.size() || leaf_of_[light] == kNoLeaf) return 0;
    double probability = 1;
    for (std::uint32_t at = leaf_of_[light]; at != 0;) {
        const std::uint32_t parent = nodes_[at].parent;
        const double share = share_of_first(point, parent);
        if (share < 0) return 0;
        probability *= at == parent + 1 ? share : 1 - share;
        at = parent;
    }
    return probability;
}

} // namespace renderer
