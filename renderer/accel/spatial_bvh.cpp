#include "renderer/accel/spatial_bvh.h"

#include "renderer/accel/grow_levels.h"
#include "renderer/accel/spatial_split.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>
#include <vector>

namespace renderer {

namespace {

// What both sides share is to be more than this of the whole tree's area, or it costs too few rays; and of the run's own, or
// looking for a plane costs more than it brings: meshes of small triangles alone took three times as long.
constexpr double kLeastOverlap = 1e-4, kLeastShare = 0.2;

// A run that is to become a subtree.
struct Run {
    RunBounds<float> bounds;
    unsigned depth = 0;
    std::size_t spare = 0; // references that it may make more
};

// Both sides of one, which lie one behind the other where it lay.
struct Halves {
    std::size_t left = 0;
    Run side[2];
};

struct Grown {
    BvhNode<float> top{};
    std::vector<BvhPair<float>> pairs; // counted from its start, as are the runs of `order`
    std::vector<std::uint32_t> order;
    unsigned depth = 0;
};

class Splitter {
public:
    Splitter(const TriangleParts& parts, const BvhOptions& options, double whole_area)
        : parts_(parts), options_(options), least_overlap_(kLeastOverlap * whole_area)
    {
    }

    // Of what `items` holds from `begin` on. False: a leaf.
    bool split(ItemRun& items, std::size_t begin, const Run& run, Halves& halves) const
    {
        const std::span<TriangleItem> here = items.from(begin);
        const CutRule rule = cut_rule(here.size(), run.depth, options_);
        if (rule == CutRule::leaf) return false;
        Sides<float> sides;
        std::size_t made = 0;
        if (rule == CutRule::sah) {
            const bool leaf_allowed = here.size() <= options_.leaf_size;
            const double limit = leaf_allowed ? leaf_tests(here.size(), options_) - options_.node_cost
                                              : std::numeric_limits<double>::infinity();
            Bins<float> bins(run.bounds, here.size());
            kernels_.add(bins, here);
            const auto cut = kernels_.best_cut(bins, run.bounds, options_.block, limit);
            if (cut) sides = kernels_.partition(here, *cut);
            if (!by_plane(items, begin, run, cut ? &sides : nullptr, limit, sides, made)) {
                if (!cut && leaf_allowed) return false;
                if (!cut) sides = split_at_median(here, run.bounds);
            }
        } else {
            sides = split_at_median(here, run.bounds);
        }
        const std::size_t all = items.size() - begin, spare = run.spare - made;
        halves.left = sides.left;
        const auto share = static_cast<std::size_t>(
            static_cast<double>(spare) * static_cast<double>(sides.left) / static_cast<double>(all));
        halves.side[0] = {sides.bounds[0], run.depth + 1, share};
        halves.side[1] = {sides.bounds[1], run.depth + 1, spare - share};
        return true;
    }

private:
    // Whether it was cut by a plane, which is cheaper than `whole` sides, or than `limit` tests where there are none.
    bool by_plane(ItemRun& items,
                  std::size_t begin,
                  const Run& run,
                  const Sides<float>* whole,
                  double limit,
                  Sides<float>& sides,
                  std::size_t& made) const
    {
        const std::size_t count = items.size() - begin;
        const double area = half_area(run.bounds.box());
        if (run.spare == 0 ||
            (whole ? overlap(*whole) : area) <= std::max(least_overlap_, kLeastShare * area))
            return false;
        double most = limit * area;
        if (whole)
            most =
                std::min(most,
                         half_area(whole->bounds[0].box()) * leaf_tests(whole->left, options_) +
                             half_area(whole->bounds[1].box()) * leaf_tests(count - whole->left, options_));
        const std::size_t room = count + run.spare;
        const auto cut = best_plane(items.from(begin), run.bounds, parts_, options_.block, room, most);
        if (!cut || !cut_by_plane(items, begin, *cut, parts_, room, sides)) return false;
        made = items.size() - begin - count;
        return true;
    }

    static double overlap(const Sides<float>& sides)
    {
        const Bounds3f a = sides.bounds[0].box(), b = sides.bounds[1].box();
        Bounds3f both;
        for (unsigned axis = 0; axis < 3; ++axis) {
            both.lower[axis] = std::max(a.lower[axis], b.lower[axis]);
            both.upper[axis] = std::min(a.upper[axis], b.upper[axis]);
        }
        return both.empty() ? 0 : half_area(both);
    }

    const TriangleParts& parts_;
    const BvhOptions& options_;
    double least_overlap_;
    const SplitKernels<float>& kernels_ = split_kernels<float>();
};

// One subtree, depth first. What is to be grown is always the end of `items`, so that it can become longer: the right
// side first, then, when it is gone, the left one.
class Grower {
public:
    Grower(const Splitter& splitter, ItemRun items, const std::stop_token& stop, Grown& out)
        : splitter_(splitter), items_(items), stop_(stop), out_(out)
    {
    }

    BvhNode<float> grow(std::size_t begin, const Run& run)
    {
        Halves halves;
        if (stop_.stop_requested() || !splitter_.split(items_, begin, run, halves)) {
            const std::size_t first = out_.order.size();
            for (std::size_t i = begin; i < items_.size(); ++i)
                out_.order.push_back(items_[i].primitive);
            items_.shorten(begin);
            return node_over(run.bounds, first, out_.order.size() - first);
        }
        const std::size_t pair = out_.pairs.size();
        out_.pairs.emplace_back();
        out_.depth = std::max(out_.depth, run.depth + 1);
        const BvhNode<float> right = grow(begin + halves.left, halves.side[1]);
        const BvhNode<float> left = grow(begin, halves.side[0]);
        out_.pairs[pair] = {{left, right}};
        return node_over(run.bounds, pair, 0);
    }

private:
    const Splitter& splitter_;
    ItemRun items_;
    const std::stop_token& stop_;
    Grown& out_;
};

// Parts a run that was cut, each side with the room that it may need: `run` becomes the left one, the right one comes back.
ItemRun part(ItemRun& run, const Halves& halves)
{
    const std::span<TriangleItem> places = run.places();
    const std::size_t rights = run.size() - halves.left, begin = halves.left + halves.side[0].spare;
    const std::span<TriangleItem> moving = run.from(halves.left);
    std::copy_backward(
        moving.begin(), moving.end(), moving.end() + static_cast<std::ptrdiff_t>(begin - halves.left));
    run = ItemRun(places.first(begin), halves.left);
    return ItemRun(places.subspan(begin), rights);
}

// A run of the first levels.
struct Open {
    ItemRun items;
    Run run;
    std::uint32_t parent = Subtree<float>::kNoParent, side = 0;
};

// Level by level, runs side by side, down to those that are short.
struct Crown {
    BvhNode<float> root{};
    std::vector<BvhPair<float>> pairs;
    std::vector<Open> subtrees;
    unsigned depth = 0;

    BvhNode<float>& place_of(const Open& run)
    {
        return run.parent == Subtree<float>::kNoParent ? root : pairs[run.parent].child[run.side];
    }

    void grow(const Open& whole, const Splitter& splitter, ThreadPool& pool, const std::stop_token& stop)
    {
        const std::size_t longest = longest_apart(whole.items.size());
        std::vector<Open> open;
        const auto take = [&](const Open& run) {
            (run.items.size() <= longest ? subtrees : open).push_back(run);
        };
        take(whole);
        while (!open.empty() && !stop.stop_requested()) {
            std::vector<Open> level = std::exchange(open, {});
            std::vector<Halves> halves(level.size());
            std::vector<ItemRun> right(level.size());
            pool.run(
                level.size(),
                [&](std::size_t i, unsigned) {
                    ItemRun& items = level[i].items;
                    splitter.split(items, 0, level[i].run, halves[i]); // runs so long are no leaves
                    right[i] = part(items, halves[i]);
                },
                stop);
            if (stop.stop_requested()) return;
            for (std::size_t i = 0; i < level.size(); ++i) {
                const auto pair = static_cast<std::uint32_t>(pairs.size());
                pairs.emplace_back();
                depth = std::max(depth, level[i].run.depth + 1);
                place_of(level[i]) = node_over(level[i].run.bounds, pair, 0);
                take({level[i].items, halves[i].side[0], pair, 0});
                take({right[i], halves[i].side[1], pair, 1});
            }
        }
    }
};

Bvh<float> join(Crown& crown, std::vector<Grown>& grown, ThreadPool& pool)
{
    std::vector<std::size_t> first_pair(grown.size()), first_place(grown.size());
    std::size_t pairs = crown.pairs.size(), places = 0;
    for (std::size_t i = 0; i < grown.size(); ++i) {
        first_pair[i] = pairs;
        first_place[i] = places;
        pairs += grown[i].pairs.size();
        places += grown[i].order.size();
        crown.depth = std::max(crown.depth, grown[i].depth);
    }
    Bvh<float> tree;
    tree.pairs = PlainArray<BvhPair<float>>(pairs);
    tree.order = PlainArray<std::uint32_t>(places);
    pool.run(grown.size(), [&](std::size_t i, unsigned) {
        const auto moved = [&](BvhNode<float> node) {
            node.first += static_cast<std::uint32_t>(node.count == 0 ? first_pair[i] : first_place[i]);
            return node;
        };
        BvhPair<float>* to = tree.pairs.data() + first_pair[i];
        for (const BvhPair<float>& pair : grown[i].pairs)
            *to++ = {{moved(pair.child[0]), moved(pair.child[1])}};
        std::copy(grown[i].order.begin(), grown[i].order.end(), tree.order.data() + first_place[i]);
        crown.place_of(crown.subtrees[i]) = moved(grown[i].top);
        grown[i] = {}; // as soon as it is copied
    });
    std::copy(crown.pairs.begin(), crown.pairs.end(), tree.pairs.begin());
    tree.root = crown.root;
    tree.depth = crown.depth;
    return tree;
}

} // namespace

std::optional<Bvh<float>> build_spatial_bvh(const Mesh& mesh,
                                            float scale,
                                            PlainArray<BuildItem<float>> items,
                                            const BvhOptions& options,
                                            ThreadPool& pool,
                                            const std::stop_token& stop)
{
    if (stop.stop_requested()) return std::nullopt;
    if (items.empty()) return Bvh<float>();
    Open whole;
    for (const TriangleItem& item : items)
        whole.run.bounds.extend(item);
    whole.run.spare = static_cast<std::size_t>(static_cast<double>(items.size()) * (kMostReferences - 1));
    PlainArray<TriangleItem> places(items.size() + whole.run.spare);
    std::copy(items.begin(), items.end(), places.begin());
    whole.items = ItemRun({places.data(), places.size()}, items.size());
    items = PlainArray<BuildItem<float>>();
    const TriangleParts parts(mesh, scale);
    const Splitter splitter(parts, options, half_area(whole.run.bounds.box()));
    Crown crown;
    crown.grow(whole, splitter, pool, stop);
    if (stop.stop_requested()) return std::nullopt;
    std::vector<Grown> grown(crown.subtrees.size());
    pool.run(
        grown.size(),
        [&](std::size_t i, unsigned) {
            const Open& subtree = crown.subtrees[i];
            Grown here; // where it will lie, its neighbour in the cache line is another thread's
            here.pairs.reserve(subtree.items.size() / 3);
            here.order.reserve(subtree.items.size() + subtree.run.spare);
            here.top = Grower(splitter, subtree.items, stop, here).grow(0, subtree.run);
            grown[i] = std::move(here);
        },
        stop);
    if (stop.stop_requested()) return std::nullopt;
    places = PlainArray<TriangleItem>();
    Bvh<float> tree = join(crown, grown, pool);
    assert(tree.depth <= kMaxBvhDepth);
    return tree;
}

} // namespace renderer
