#include "renderer/accel/instance_tree.h"

#include "renderer/accel/traverse.h"

#include <algorithm>
#include <atomic>
#include <utility>
#include <variant>

namespace renderer {

namespace {

// Building the tree instead of refitting takes as long for each instance as visiting so many inner nodes: 0.7 us more, and
// 15 to 20 ns.
constexpr double kVisitsToBuildOne = 40;

// What an instance is, wherever it stands.
std::uint64_t kind_of(const InstanceGeometry& geometry)
{
    const Mesh* const mesh = mesh_behind(geometry);
    return (mesh != nullptr ? mesh->triangles.size() : 0) * std::variant_size_v<InstanceGeometry> +
           geometry.index();
}

} // namespace

struct InstanceTree::Best {
    bool found = false;
    std::uint32_t asked = 0;
    Instance::Candidate candidate{};

    void improve(const InstanceTree& tree, std::uint32_t number, const Instance::Candidate& hit)
    {
        if (!found || tree.is_better(number, hit, asked, candidate)) *this = {true, number, hit};
    }
};

// Nearer, or as near and of an earlier instance.
bool InstanceTree::is_better(std::uint32_t number,
                             const Instance::Candidate& hit,
                             std::uint32_t best_number,
                             const Instance::Candidate& best) const
{
    if (hit.t != best.t) return hit.t < best.t;
    const auto instance_of = [&](std::uint32_t asked, const Instance::Candidate& found) {
        return asked < instances_.size() ? asked : joined_->instance_of(found.primitive);
    };
    return instance_of(number, hit) < instance_of(best_number, best);
}

InstanceTree::InstanceTree(std::vector<Instance> instances, std::optional<JoinedMesh> joined)
    : instances_(std::move(instances)), joined_(std::move(joined))
{
    if (!joined_) return;
    is_joined_.resize(instances_.size());
    for (const JoinedMesh::Member& member : joined_->members())
        is_joined_[member.instance] = 1;
}

Bounds3d InstanceTree::box_to_meet(std::uint32_t number) const
{
    const bool is_elsewhere = number < is_joined_.size() && is_joined_[number] != 0;
    return is_elsewhere ? Bounds3d{} : asked(number).world_bounds();
}

InstanceTree::InstanceTree(std::vector<Instance> instances,
                           BvhSplit split,
                           ThreadPool& pool,
                           std::optional<JoinedMesh> joined,
                           const EarlierFrames& earlier,
                           const std::stop_token& stop)
    : InstanceTree(std::move(instances), std::move(joined))
{
    PlainArray<BuildItem<double>> items(asked_count());
    constexpr std::size_t kShare = 1024; // instances that a thread takes at once
    std::atomic<std::uint64_t> kinds = 0;
    pool.run((items.size() + kShare - 1) / kShare, [&](std::size_t share, unsigned) {
        std::uint64_t sum = 0;
        for (std::size_t i = share * kShare; i < std::min(items.size(), (share + 1) * kShare); ++i) {
            const auto number = static_cast<std::uint32_t>(i);
            const Bounds3d box = box_to_meet(number);
            items[i] = {box.lower, number, box.upper};
            sum += (2 * i + 1) * kind_of(asked(number).geometry());
        }
        kinds += sum;
    });
    const BvhTopologyCache::Built built{split, items.size(), kinds};
    if (earlier.trees != nullptr && earlier.rays > 0) {
        const double visits_more = kVisitsToBuildOne * static_cast<double>(items.size()) / earlier.rays;
        auto refitted = earlier.trees->refit({items.data(), items.size()}, built, visits_more, pool);
        if (refitted) {
            bvh_ = std::move(*refitted);
            bounds_ = {bvh_.root.lower, bvh_.root.upper};
            upper_level_ = UpperLevel::refitted;
            return;
        }
    }
    std::size_t count = 0;
    for (const BuildItem<double>& item : items) {
        const Bounds3d box{item.lower, item.upper};
        if (box.empty()) continue;
        bounds_.extend(box);
        items[count++] = item;
    }
    items.shorten(count);
    auto tree = build_bvh<double>(std::move(items), {.split = split, .leaf_size = 1}, pool, stop);
    if (!tree) return;
    bvh_ = std::move(*tree);
    if (bvh_.pairs.empty()) return;
    upper_level_ = UpperLevel::built;
    if (earlier.trees != nullptr) earlier.trees->keep(bvh_, built);
}

InstanceTree
InstanceTree::list(std::vector<Instance> instances, bool boxes_first, std::optional<JoinedMesh> joined)
{
    InstanceTree tree(std::move(instances), std::move(joined));
    tree.boxes_first_ = boxes_first;
    for (std::uint32_t i = 0; i < tree.asked_count(); ++i) {
        const Bounds3d box = tree.box_to_meet(i);
        if (box.empty()) continue;
        tree.bounds_.extend(box);
        tree.listed_.push_back({i, box});
    }
    return tree;
}

void InstanceTree::consider(const Ray& ray, RayKind kind, std::uint32_t number, Best& best) const
{
    const Instance& instance = asked(number);
    if (!instance.visible_to(kind)) return;
    if (const std::optional<Instance::Candidate> hit = instance.closest_hit(ray))
        best.improve(*this, number, *hit);
}

SceneHit InstanceTree::resolve(const Ray& ray, const Best& best) const
{
    if (best.asked >= instances_.size()) return joined_->resolve(best.candidate, instances_);
    SceneHit hit = instances_[best.asked].resolve(ray, best.candidate);
    hit.instance = best.asked;
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

template <typename Ask>
void InstanceTree::ask_listed(const Ray& ray, const double& end, Ask&& ask) const
{
    if (!is_traceable(ray)) return;
    const SlabRay<double> slabs = slabs_of(ray, bounds_);
    double entry = 0, exit = 0;
    for (const Listed& one : listed_) {
        if (boxes_first_ && !slabs.meets(one.box.lower, one.box.upper, ray.t_min, end, entry, exit)) continue;
        if (ask(one.number)) return;
    }
}

std::optional<SceneHit> InstanceTree::closest_hit(const Ray& ray, RayKind kind) const
{
    Best best;
    if (bvh_.order.size() == 1) {
        consider(ray, kind, bvh_.order[0], best);
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
                         end = best.candidate.t;
                         shortened.t_max = just_past(end, ray.t_max);
                     }
                     return false;
                 });
    } else {
        Ray shortened = ray;
        double end = ray.t_max;
        ask_listed(ray, end, [&](std::uint32_t number) {
            consider(shortened, kind, number, best);
            if (!best.found) return false;
            end = best.candidate.t;
            shortened.t_max = just_past(end, ray.t_max);
            return false;
        });
    }
    if (!best.found) return std::nullopt;
    return resolve(ray, best);
}

bool InstanceTree::any_hit(const Ray& ray, RayKind kind) const
{
    if (bvh_.order.size() == 1) {
        const Instance& only = asked(bvh_.order[0]);
        return only.visible_to(kind) && only.any_hit(ray);
    }
    bool found = false;
    if (!listed_.empty())
        ask_listed(ray, ray.t_max, [&](std::uint32_t number) {
            return found = asked(number).visible_to(kind) && asked(number).any_hit(ray);
        });
    if (bvh_.empty() || !is_traceable(ray)) return found;
    traverse(bvh_,
             slabs_of(ray, bounds_),
             ray.t_min,
             ray.t_max,
             [&](std::uint32_t first, std::uint32_t count, double&) {
                 for (std::uint32_t i = first; i < first + count && !found; ++i) {
                     const Instance& instance = asked(bvh_.order[i]);
                     found = instance.visible_to(kind) && instance.any_hit(ray);
                 }
                 return found;
             });
    return found;
}

std::optional<SceneHit> InstanceTree::closest_hit_brute_force(const Ray& ray, RayKind kind) const
{
    Best best;
    for (std::uint32_t i = 0; i < asked_count(); ++i)
        if (!box_to_meet(i).empty()) consider(ray, kind, i, best);
    if (!best.found) return std::nullopt;
    return resolve(ray, best);
}

} // namespace renderer
