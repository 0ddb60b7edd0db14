#include "renderer/accel/grow_levels.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>
#include <utility>

namespace renderer {

namespace {

constexpr std::size_t kShare = 8192; // items that a thread takes at once

template <typename T>
using Buffers = std::span<BuildItem<T>>[2];

template <typename T>
std::span<BuildItem<T>> run_of(const Buffers<T>& buffers, const Subtree<T>& tree)
{
    return buffers[tree.buffer].subspan(tree.begin, tree.size());
}

template <typename T>
RunBounds<T> bounds_of(std::span<const BuildItem<T>> items, ThreadPool& pool)
{
    std::vector<RunBounds<T>> parts((items.size() + kShare - 1) / kShare);
    pool.run_near(parts.size(), [&](std::size_t i, unsigned) {
        RunBounds<T> bounds;
        for (const BuildItem<T>& item :
             items.subspan(i * kShare, std::min(kShare, items.size() - i * kShare)))
            bounds.extend(item);
        parts[i] = bounds;
    });
    RunBounds<T> all;
    for (const RunBounds<T>& part : parts)
        all.extend(part);
    return all;
}

// One level: long runs, each cut in two.
template <typename T>
class Level {
public:
    Level(std::vector<Subtree<T>> runs, const Buffers<T>& buffers, const BvhOptions& options)
        : runs_(std::move(runs)), buffers_(buffers), options_(options), cuts_(runs_.size())
    {
        for (std::size_t i = 0; i < runs_.size(); ++i) {
            cuts_[i].rule = cut_rule(runs_[i].size(), runs_[i].depth, options_);
            for (std::size_t from = 0; from < runs_[i].size(); from += kShare) {
                shares_.push_back({i, from, std::min(kShare, runs_[i].size() - from), 0, 0, 0, {}});
                if (cuts_[i].rule == CutRule::sah) {
                    shares_.back().bins = bins_.size();
                    bins_.emplace_back(runs_[i].bounds, runs_[i].size());
                }
            }
        }
    }

    void cut(ThreadPool& pool, const std::stop_token& stop)
    {
        const auto count = [&](std::size_t i, unsigned) {
            if (const Share& share = shares_[i]; cuts_[share.run].rule == CutRule::sah)
                kernels_.add(bins_[share.bins], items_of(share));
        };
        const auto move = [&](std::size_t i, unsigned) {
            Share& share = shares_[i];
            const RunCut& run = cuts_[share.run];
            if (!run.cut) return;
            BuildItem<T>* const to = buffers_[1 - runs_[share.run].buffer].data() + runs_[share.run].begin;
            share.sides = kernels_.scatter(items_of(share),
                                           *run.cut,
                                           to + share.lefts_before,
                                           to + run.sides.left + share.rights_before);
        };
        pool.run_near(shares_.size(), count, stop);
        if (stop.stop_requested()) return;
        choose();
        pool.run_near(shares_.size(), move, stop);
        for (const Share& share : shares_)
            if (cuts_[share.run].cut)
                for (std::size_t side = 0; side < 2; ++side)
                    cuts_[share.run].sides.bounds[side].extend(share.sides.bounds[side]);
    }

    // Makes a pair of every run; both its children are handed over.
    template <typename Take>
    void hang_into(FirstLevels<T>& tree, Take&& take) const
    {
        for (std::size_t i = 0; i < runs_.size(); ++i) {
            const Subtree<T>& run = runs_[i];
            const auto pair = static_cast<std::uint32_t>(tree.pairs.size());
            tree.pairs.emplace_back();
            tree.depth = std::max(tree.depth, run.depth + 1);
            (run.parent == Subtree<T>::kNoParent ? tree.root : tree.pairs[run.parent].child[run.side]) =
                node_over(run.bounds, pair, 0);
            const std::size_t middle = run.begin + cuts_[i].sides.left;
            const unsigned buffer = cuts_[i].cut ? 1 - run.buffer : run.buffer;
            const auto& bounds = cuts_[i].sides.bounds;
            take(Subtree<T>{run.begin, middle, buffer, bounds[0], run.depth + 1, pair, 0});
            take(Subtree<T>{middle, run.end, buffer, bounds[1], run.depth + 1, pair, 1});
        }
    }

private:
    struct Share {
        std::size_t run, from, size;
        std::size_t bins;
        std::size_t lefts_before, rights_before; // in its run
        Sides<T> sides;
    };
    struct RunCut {
        CutRule rule{};
        std::optional<Cut<T>> cut; // none: halved where it lies
        Sides<T> sides;
    };

    std::span<const BuildItem<T>> items_of(const Share& share) const
    {
        return run_of(buffers_, runs_[share.run]).subspan(share.from, share.size);
    }

    void choose()
    {
        for (std::size_t i = 0, first = 0; i < runs_.size(); ++i) {
            const std::size_t end = first + (runs_[i].size() + kShare - 1) / kShare;
            choose(i, first, end);
            first = end;
        }
    }

    // For run i, whose shares are [first, end).
    void choose(std::size_t i, std::size_t first, std::size_t end)
    {
        const Subtree<T>& run = runs_[i];
        RunCut& chosen = cuts_[i];
        if (chosen.rule == CutRule::midpoint) chosen.cut = cut_at_midpoint(run.bounds);
        if (chosen.rule == CutRule::sah) {
            Bins<T> all = bins_[shares_[first].bins];
            for (std::size_t s = first + 1; s < end; ++s)
                all.merge(bins_[shares_[s].bins]);
            chosen.cut =
                kernels_.best_cut(all, run.bounds, options_.block, std::numeric_limits<double>::infinity());
        }
        if (!chosen.cut) {
            chosen.sides = split_at_median<T>(run_of(buffers_, run), run.bounds);
            return;
        }
        std::size_t lefts = 0, rights = 0;
        for (std::size_t s = first; s < end; ++s) {
            Share& share = shares_[s];
            share.lefts_before = lefts;
            share.rights_before = rights;
            const std::size_t left = chosen.rule == CutRule::sah
                                         ? bins_[share.bins].count_left(*chosen.cut)
                                         : kernels_.count_left(items_of(share), *chosen.cut);
            lefts += left;
            rights += share.size - left;
        }
        chosen.sides.left = lefts;
    }

    std::vector<Subtree<T>> runs_;
    const Buffers<T>& buffers_;
    const BvhOptions& options_;
    std::vector<RunCut> cuts_;
    std::vector<Share> shares_; // run by run
    std::vector<Bins<T>> bins_;
    const SplitKernels<T>& kernels_ = split_kernels<T>();
};

} // namespace

CutRule cut_rule(std::size_t items, unsigned depth, const BvhOptions& options)
{
    if (items < 2) return CutRule::leaf;
    const bool leaf_allowed = items <= options.leaf_size;
    // Halving n items takes bit_width(n - 1) levels: from here on only that keeps the promise of the depth.
    if (depth + static_cast<unsigned>(std::bit_width(items - 1)) >= kMaxBvhDepth)
        return leaf_allowed ? CutRule::leaf : CutRule::median;
    if (options.split == BvhSplit::midpoint) return leaf_allowed ? CutRule::leaf : CutRule::midpoint;
    // No cut can pay for its visit.
    if (leaf_allowed && leaf_tests(items, options) <= options.node_cost) return CutRule::leaf;
    return CutRule::sah;
}

// Depends on the input alone.
std::size_t longest_apart(std::size_t items)
{
    return std::max<std::size_t>(4096, items / 256);
}

template <typename T>
FirstLevels<T> grow_levels(std::span<BuildItem<T>> items,
                           std::span<BuildItem<T>> spare,
                           const BvhOptions& options,
                           ThreadPool& pool,
                           const std::stop_token& stop)
{
    const Buffers<T> buffers{items, spare};
    FirstLevels<T> tree;
    std::vector<Subtree<T>> open;
    const auto take = [&](const Subtree<T>& run) {
        (run.size() <= longest_apart(items.size()) ? tree.subtrees : open).push_back(run);
    };
    take({0, items.size(), 0, bounds_of<T>(items, pool), 0, Subtree<T>::kNoParent, 0});
    while (!open.empty()) {
        Level<T> level(std::exchange(open, {}), buffers, options);
        level.cut(pool, stop);
        if (stop.stop_requested()) return tree;
        level.hang_into(tree, take);
    }
    return tree;
}

template FirstLevels<float> grow_levels(std::span<BuildItem<float>>,
                                        std::span<BuildItem<float>>,
                                        const BvhOptions&,
                                        ThreadPool&,
                                        const std::stop_token&);
template FirstLevels<double> grow_levels(std::span<BuildItem<double>>,
                                         std::span<BuildItem<double>>,
                                         const BvhOptions&,
                                         ThreadPool&,
                                         const std::stop_token&);

} // namespace renderer
