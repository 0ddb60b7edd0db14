#include "renderer/accel/instance_tree.h"
#include "renderer/geometry/shapes.h"
#include "tests/renderer/accel/random_scenes.h"
#include "tests/support/thinning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace {

using namespace renderer;
using random_scenes::Random;

using tests::kThinning;

class Objects {
public:
    explicit Objects(MeshTree tree = MeshTree::wide_sah) : tree_(tree) {}

    void add(Mesh mesh, const Affine3& placed, bool is_joined = true)
    {
        meshes_.push_back(prepare_mesh(std::move(mesh), tree_, pool_));
        const PreparedMesh& made = *meshes_.back();
        const auto number = static_cast<std::uint32_t>(instances_.size());
        if (is_joined)
            members_.push_back({number, {0, static_cast<std::uint32_t>(mesh_of(made).triangles.size())}});
        if (const MeshBvh* const bvh = bvh_of(made))
            add(MeshGeometry{&mesh_of(made), bvh}, placed);
        else
            add(BaselineGeometry{&mesh_of(made), baseline_of(made)}, placed);
    }
    void add(InstanceGeometry geometry, const Affine3& placed)
    {
        instances_.push_back(Instance::place(geometry, placed).value());
    }

    InstanceTree apart() { return {instances_, BvhSplit::sah, pool_}; }
    InstanceTree joined(const EarlierFrames& earlier = {})
    {
        return {instances_, BvhSplit::sah, pool_, join(), earlier};
    }
    void move(std::size_t number, const Affine3& by)
    {
        Instance& instance = instances_[number];
        instance = Instance::place(instance.geometry(), by * instance.world_from_object()).value();
    }
    InstanceTree listed(bool boxes_first) { return InstanceTree::list(instances_, boxes_first, join()); }

private:
    std::optional<JoinedMesh> join() { return JoinedMesh::join(instances_, members_, tree_, pool_); }

    MeshTree tree_;
    ThreadPool pool_{1};
    std::vector<std::shared_ptr<const PreparedMesh>> meshes_;
    std::vector<Instance> instances_;
    std::vector<JoinedMesh::Member> members_;
};

Affine3 random_placing(Random& random, double spread)
{
    const Vec3d s{random.exponential(0.5), random.exponential(0.5), random.exponential(0.5)};
    return Affine3::translate(random.direction() * spread) *
           Affine3::rotate_deg(random.uniform(0, 360), random.direction()) * Affine3::scale(s);
}

void add_random(Objects& objects, Random& random)
{
    const Affine3 placed = random_placing(random, 3);
    switch (random.below(5)) {
    case 0:
        return objects.add(unit_box(), placed);
    case 1:
        return objects.add(unit_rectangle(), placed);
    case 2:
        return objects.add(Sphere{random.uniform(0.2, 1)}, placed);
    case 3:
        return objects.add(unit_box(), placed, false);
    default:
        return objects.add(random_scenes::soup(random, 20, 0.5, 0.5), placed);
    }
}

Ray random_ray(Random& random)
{
    const Vec3d origin = random.direction() * random.uniform(0, 20);
    Ray ray{origin, random.in_box({-3, -3, -3}, {3, 3, 3}) - origin};
    if (random.below(4) == 0) ray.t_max = random.uniform(0, 1);
    return ray;
}

void expect_same(const SceneHit& a, const SceneHit& b)
{
    EXPECT_EQ(a.t, b.t);
    EXPECT_EQ(a.instance, b.instance);
    EXPECT_EQ(a.primitive, b.primitive);
    EXPECT_EQ(a.point.position, b.point.position);
    EXPECT_EQ(a.point.error, b.point.error);
    EXPECT_EQ(a.point.normal, b.point.normal);
    EXPECT_EQ(a.object_position, b.object_position);
}

} // namespace

TEST(JoinedMesh, GivesTheSameBitsThroughEveryTreeAndRun)
{
    for (const int count : {2, 3, 10, 100}) {
        Objects wide, binary(MeshTree::binary_sah), none(MeshTree::none);
        for (Objects* objects : {&wide, &binary, &none}) {
            Random random(static_cast<std::uint64_t>(count));
            objects->add(unit_box(), Affine3::translate({1, 0, 0}));
            for (int i = 1; i < count; ++i)
                add_random(*objects, random);
        }
        const InstanceTree trees[] = {
            wide.joined(), wide.listed(false), wide.listed(true), binary.joined(), none.listed(false)};
        Random random(7);
        int hits = 0;
        for (int i = 0; i < 100 / kThinning + 1; ++i) {
            std::vector<Ray> rays;
            for (unsigned k = 0; k < InstanceTree::kMostRays; ++k)
                rays.push_back(random_ray(random));
            for (const InstanceTree& tree : trees) {
                std::vector<SceneHit> found(rays.size());
                const auto met = tree.closest_hits(rays, found), shadowed = tree.any_hits(rays);
                for (std::size_t k = 0; k < rays.size(); ++k) {
                    const auto expected = trees[0].closest_hit_brute_force(rays[k]);
                    const auto alone = tree.closest_hit(rays[k]);
                    ASSERT_EQ((met >> k & 1) != 0, expected.has_value());
                    ASSERT_EQ((shadowed >> k & 1) != 0, expected.has_value());
                    ASSERT_EQ(alone.has_value(), expected.has_value());
                    ASSERT_EQ(tree.any_hit(rays[k]), expected.has_value());
                    if (!expected) continue;
                    ++hits;
                    expect_same(found[k], *expected);
                    expect_same(*alone, *expected);
                }
            }
        }
        EXPECT_GT(hits, 100 / kThinning);
    }
}

TEST(JoinedMesh, FindsWhatIsFoundApartButForRounding)
{
    Random random(11);
    Objects objects;
    for (int i = 0; i < 40; ++i)
        add_random(objects, random);
    const InstanceTree apart = objects.apart(), joined = objects.joined();
    int hits = 0, others = 0;
    for (int i = 0; i < 20000 / kThinning; ++i) {
        const Ray ray = random_ray(random);
        const auto a = apart.closest_hit(ray), b = joined.closest_hit(ray);
        if (a.has_value() != b.has_value() || (a && a->instance != b->instance)) {
            ++others; // at an edge
            continue;
        }
        if (!a) continue;
        ++hits;
        ASSERT_NEAR(a->t, b->t, 1e-12 * (1 + a->t));
        if (a->primitive != b->primitive) continue; // where two meet
        ASSERT_LE(max_component(abs(a->point.position - b->point.position)), 1e-11);
        ASSERT_LE(max_component(abs(a->object_position - b->object_position)), 1e-11);
        ASSERT_LE(max_component(abs(a->barycentrics - b->barycentrics)), 1e-9);
        // As unit vectors of either way are rounded; mirrored ones point to the outside too.
        ASSERT_LE(max_component(abs(a->point.normal - b->point.normal)), 1e-14);
    }
    EXPECT_GT(hits, 5000 / kThinning);
    EXPECT_LE(others, 2);
}

TEST(JoinedMesh, LetsNoRayThroughAClosedBody)
{
    Random random(5);
    for (int body = 0; body < 20; ++body) {
        Objects objects;
        const Mesh mesh = random_scenes::closed_sphere(random, {}, 0.5, 1, 6, 9);
        const Affine3 placed = random_placing(random, 30);
        objects.add(mesh, placed);
        objects.add(unit_box(), Affine3::translate({100, 0, 0}));
        const InstanceTree tree = objects.joined();
        std::vector<Ray> rays;
        const auto ask = [&] {
            std::vector<SceneHit> found(rays.size());
            const std::uint64_t all = ~std::uint64_t{0} >> (InstanceTree::kMostRays - rays.size());
            ASSERT_EQ(tree.closest_hits(rays, found), all);
            ASSERT_EQ(tree.any_hits(rays), all);
            rays.clear();
        };
        const Vec3d inside = placed.point({});
        for (int i = 0; i < 5000 / kThinning; ++i) {
            // At corners and edges.
            const Triangle& v =
                mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
            const double along = random.below(3) == 0 ? 0 : random.uniform();
            const Vec3d at = mesh.position(v[0]) * (1 - along) + mesh.position(v[1]) * along;
            rays.push_back({inside, placed.point(at) - inside});
            if (rays.size() == InstanceTree::kMostRays) ask();
        }
    }
}

TEST(JoinedMesh, ARayThatLeavesAHitDoesNotMeetItAgain)
{
    Random random(9);
    Objects objects;
    std::vector<Affine3> places;
    for (int i = 0; i < 40; ++i) {
        places.push_back(random_placing(random, 1000));
        objects.add(unit_box(), places.back());
    }
    const InstanceTree tree = objects.joined();
    int hits = 0;
    for (int i = 0; i < 20000 / kThinning; ++i) {
        const Vec3d origin = random.direction() * 1500.0;
        const Affine3& aimed_at = places[random.below(40)];
        const Ray ray{origin, aimed_at.point(random.direction() * 0.4) - origin};
        const auto hit = tree.closest_hit(ray);
        if (!hit) continue;
        ++hits;
        // Boxes are convex: nothing of the same one lies outside.
        Vec3d way = random.direction();
        if (dot(way, hit->point.normal) < 0) way = -way;
        const auto next = tree.closest_hit({offset_origin(hit->point, way), way});
        if (next) {
            ASSERT_NE(next->instance, hit->instance);
        }
    }
    EXPECT_GT(hits, 10000 / kThinning);
}

TEST(JoinedMesh, PrefersTheLowestInstanceAmongEquals)
{
    for (const bool first_is_joined : {true, false}) {
        Objects objects;
        const Affine3 exact = Affine3::translate({2, 4, 8}); // so that both ways have the same corners
        objects.add(Sphere{0.1}, Affine3::translate({9, 9, 9}));
        for (int i = 0; i < 6; ++i)
            objects.add(unit_box(), exact, (i % 2 == 0) == first_is_joined);
        const InstanceTree tree = objects.joined();
        Random random(2);
        // Of few digits, so that they are the same in every frame, and so is t.
        const auto few_digits = [](Vec3d v) {
            return Vec3d{std::round(v.x * 0x1p16), std::round(v.y * 0x1p16), std::round(v.z * 0x1p16)} *
                   0x1p-16;
        };
        for (int i = 0; i < 1000; ++i) {
            const Vec3d origin = few_digits(random.direction() * 3.0);
            const auto hit =
                tree.closest_hit({Vec3d{2, 4, 8} + origin, few_digits(random.direction() * 0.3) - origin});
            ASSERT_TRUE(hit);
            ASSERT_EQ(hit->instance, 1u) << first_is_joined;
        }
    }
}

TEST(JoinedMesh, IsFoundWhereItsMembersHaveMovedInARefittedTree)
{
    Random random(13);
    Objects objects;
    constexpr std::size_t kCount = 60;
    for (std::size_t i = 0; i < kCount; ++i)
        add_random(objects, random);
    BvhTopologyCache trees;
    const EarlierFrames earlier{&trees, 1e-3}; // so few rays are worth no building
    objects.joined(earlier);
    for (const double by : {0.0, 0.1, 3.0}) {
        for (std::size_t i = 0; i < kCount; i += 3)
            objects.move(i, Affine3::translate(random.direction() * by));
        const InstanceTree refitted = objects.joined(earlier), built = objects.joined();
        ASSERT_EQ(refitted.upper_level(), UpperLevel::refitted);
        int hits = 0;
        for (int i = 0; i < 3000 / kThinning; ++i) {
            const Ray ray = random_ray(random);
            const auto hit = refitted.closest_hit(ray), expected = built.closest_hit_brute_force(ray);
            ASSERT_EQ(hit.has_value(), expected.has_value());
            ASSERT_EQ(refitted.any_hit(ray), expected.has_value());
            if (!hit) continue;
            expect_same(*hit, *expected);
            ++hits;
        }
        EXPECT_GT(hits, 300 / kThinning);
    }
}

TEST(JoinedMesh, OfTrianglesWithoutAreaIsNeverHit)
{
    Objects objects;
    for (int i = 0; i < 3; ++i) {
        Mesh needle;
        needle.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
        needle.triangles = {{0, 1, 2}};
        objects.add(std::move(needle), Affine3::translate({static_cast<double>(i), 0, 0}));
    }
    const InstanceTree tree = objects.joined();
    Random random(3);
    for (int i = 0; i < 100; ++i)
        EXPECT_FALSE(tree.closest_hit(random_ray(random)));
}
