// Objects for the tests of instances and their tree.
#pragma once

#include "renderer/accel/instance_tree.h"
#include "renderer/accel/prepared_mesh.h"
#include "tests/renderer/accel/random_scenes.h"

#include <gtest/gtest.h>

#include <memory>
#include <stop_token>
#include <utility>
#include <vector>

namespace renderer {

// Keeps meshes alive while instances point at them.
class Objects {
public:
    void add(Mesh mesh, const Affine3& placed, bool visible_to_camera = true)
    {
        meshes_.push_back(prepare_mesh(std::move(mesh), MeshTree::wide_sah, pool_));
        add(MeshGeometry{&mesh_of(*meshes_.back()), bvh_of(*meshes_.back())}, placed, visible_to_camera);
    }
    void add(InstanceGeometry geometry, const Affine3& placed, bool visible_to_camera = true)
    {
        const auto instance = Instance::place(geometry, placed, visible_to_camera);
        ASSERT_TRUE(instance);
        instances_.push_back(*instance);
    }
    void move(std::size_t number, const Affine3& by)
    {
        Instance& instance = instances_[number];
        const auto there = Instance::place(
            instance.geometry(), by * instance.world_from_object(), instance.visible_to(RayKind::camera));
        ASSERT_TRUE(there);
        instance = *there;
    }
    std::size_t size() const { return instances_.size(); }

    InstanceTree
    tree(BvhSplit split = BvhSplit::sah, const EarlierFrames& earlier = {}, const std::stop_token& stop = {})
    {
        return {instances_, split, pool_, std::nullopt, earlier, stop};
    }
    InstanceTree list(bool boxes_first) { return InstanceTree::list(instances_, boxes_first); }

private:
    ThreadPool pool_{1};
    std::vector<std::shared_ptr<const PreparedMesh>> meshes_;
    std::vector<Instance> instances_;
};

inline Affine3 random_placing(random_scenes::Random& random, double spread)
{
    const Vec3d s{
        random.exponential(0.5), random.exponential(0.5), random.exponential(0.5)}; // mirrored half the time
    return Affine3::translate(random.direction() * spread) *
           Affine3::rotate_deg(random.uniform(0, 360), random.direction()) * Affine3::scale(s);
}

} // namespace renderer
