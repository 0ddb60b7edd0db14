// What the tests of a mesh's kernels share: a kernel's answers beside those of all triangles in turn.
#pragma once

#include "renderer/accel/mesh_kernels.h"
#include "tests/renderer/accel/mesh_rays.h"

#include <gtest/gtest.h>

#include <optional>
#include <span>
#include <vector>

namespace renderer::mesh_rays {

inline constexpr unsigned kRun = MeshKernels::kMostRays;

class MeshKernelTest : public testing::TestWithParam<MeshKernels> {
protected:
    // The run's answers are those of its rays, one by one, from all triangles in turn.
    void expect_as_brute_force(const MeshBvh& bvh, std::span<const Ray> rays)
    {
        struct Answer {
            MeshHit hits[kRun];
            std::uint64_t found = 0, met = 0;
        };
        Answer answers[2]; // walks together, and what is done where they have not paid
        for (const bool lost : {false, true}) {
            bvh.fans() = {};
            for (int i = 0; i < 1000 && lost; ++i) {
                bvh.fans().nearest.tell(false);
                bvh.fans().any.tell(false);
            }
            Answer& answer = answers[lost ? 1 : 0];
            answer.found = bvh.closest_hits(rays, answer.hits, GetParam());
            answer.met = bvh.any_hits(rays, GetParam());
        }
        expect_apart_as_brute_force(bvh, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto expected = bvh.closest_hit_brute_force(rays[i]);
            for (const Answer& answer : answers) {
                const bool hit = (answer.found >> i & 1) != 0;
                ASSERT_TRUE(same(hit ? std::optional(answer.hits[i]) : std::nullopt, expected))
                    << "ray " << i << " of a run";
                ASSERT_EQ((answer.met >> i & 1) != 0, expected.has_value()) << "ray " << i << " of a run";
            }
            ASSERT_TRUE(same(bvh.closest_hit(rays[i], GetParam()), expected)) << "ray " << i << " alone";
            ASSERT_EQ(bvh.any_hit(rays[i], GetParam()), expected.has_value()) << "ray " << i << " alone";
            hits_ += expected.has_value();
            ++rays_;
        }
        for (const Answer& answer : answers)
            ASSERT_EQ((answer.found | answer.met) >> (rays.size() - 1) >> 1, std::uint64_t{0})
                << "rays that are not there have hit";
    }

    void expect_apart_as_brute_force(const MeshBvh& bvh, std::span<const Ray> rays)
    {
        std::vector<MeshHit> hits(rays.size()), met(rays.size());
        bvh.closest_hits_apart(rays, hits, GetParam());
        bvh.any_hits_apart(rays, met, GetParam());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto expected = bvh.closest_hit_brute_force(rays[i]);
            const bool hit = hits[i].primitive != TriangleBlock::kNone;
            ASSERT_TRUE(same(hit ? std::optional(hits[i]) : std::nullopt, expected))
                << "ray " << i << " apart";
            ASSERT_EQ(met[i].primitive != TriangleBlock::kNone, expected.has_value())
                << "ray " << i << " apart";
            hits_ += hit;
            ++rays_;
        }
    }

    int hits_ = 0, rays_ = 0;
};

} // namespace renderer::mesh_rays
