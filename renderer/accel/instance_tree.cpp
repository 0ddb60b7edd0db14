#include "renderer/accel/instance_tree.h"

#include "renderer/accel/traverse.h"

#include <utility>

namespace renderer {

struct InstanceTree::Best {
    bool found = false;
    std::uint32_t instance = 0;
    Instance::Candidate candidate{};
};

InstanceTree::InstanceTree(std::vector<Instance> instances, BvhSplit split, ThreadPool& pool)
    : instances_(std::move(instances))
{
    std::vector<Bounds3d> boxes;
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < instances_.size(); ++i) {
        const Bounds3d box = instances_[i].world_bounds();
        if (box.empty()) continue;
        bounds_.extend(box);
        boxes.push_back(box);
        numbers.push_back(i);
    }
    bvh_ = *build_bvh<double>(boxes, {.split = split, .leaf_size = 1}, pool);
    for (std::uint32_t& number : bvh_.order)
        number = numbers[number];
}

void InstanceTree::consider(const Ray& ray, RayKind kind, std::uint32_t number, Best& best) const
{
    if (!instances_[number].visible_to(kind)) return;
    const std::optional<Instance::Candidate> hit = instances_[number].closest_hit(ray);
    if (!hit) return;
    if (best.found && (hit->t > best.candidate.t || (hit->t == best.candidate.t && number > best.instance)))
        return;
    best = {true, number, *hit};
}

std::optional<SceneHit> InstanceTree::resolve(const Ray& ray, const Best& best) const
{
    if (!best.found) return std::nullopt;
    SceneHit hit = instances_[best.instance].resolve(ray, best.candidate);
    hit.instance = best.instance;
    return hit;
}

namespace {

// Boxes are met with the slack of double arithmetic on this ray.
SlabRay<double> slabs_of(const Ray& ray, const Bounds3d& bounds)
{
    const double size = std::max(max_abs(bounds.lower), max_abs(bounds.upper));
    return {ray.origin, reciprocal(ray.direction), 0x1p-49 * (max_abs(ray.origin) + size)};
}

} // namespace

std::optional<SceneHit> InstanceTree::closest_hit(const Ray& ray, RayKind kind) const
{
    Best best;
    if (bvh_.order.size() == 1) {
        consider(ray, kind, bvh_.order.front(), best);
    } else if (!bvh_.empty() && is_traceable(ray)) {
        Ray shortened = ray;
        traverse(bvh_,
                 slabs_of(ray, bounds_),
                 ray.t_min,
                 ray.t_max,
                 [&](std::uint32_t first, std::uint32_t count, double& end) {
                     for (std::uint32_t i = first; i < first + count; ++i) {
                         consider(shortened, kind, bvh_.order[i], best);
                         if (!best.found) continue;
                         // Past the best hit, ties still seen.
                         end = best.candidate.t;
                         shortened.t_max = std::min(
                             ray.t_max, std::nextafter(end, std::numeric_limits<double>::infinity()));
                     }
                     return false;
                 });
    }
    return resolve(ray, best);
}

bool InstanceTree::any_hit(const Ray& ray, RayKind kind) const
{
    if (bvh_.order.size() == 1) {
        const Instance& only = instances_[bvh_.order.front()];
        return only.visible_to(kind) && only.any_hit(ray);
    }
    if (bvh_.empty() || !is_traceable(ray)) return false;
    bool found = false;
    traverse(bvh_,
             slabs_of(ray, bounds_),
             ray.t_min,
             ray.t_max,
             [&](std::uint32_t first, std::uint32_t count, double&) {
                 for (std::uint32_t i = first; i < first + count && !found; ++i) {
                     const Instance& instance = instances_[bvh_.order[i]];
                     found = instance.visible_to(kind) && instance.any_hit(ray);
                 }
                 return found;
             });
    return found;
}

std::optional<SceneHit> InstanceTree::closest_hit_brute_force(const Ray& ray, RayKind kind) const
{
    Best best;
    for (std::uint32_t i = 0; i < instances_.size(); ++i)
        consider(ray, kind, i, best);
    return resolve(ray, best);
}

} // namespace renderer
