#include "tests/bench/ray_engine.h"

#ifdef HELIOGRAPH_EMBREE
#include "renderer/parallel/thread_pool.h"
#include "tests/bench/fresh_process.h"
#include "tests/bench/stopwatch.h"

#include <algorithm>
#include <atomic>
#include <embree3/rtcore.h>
#include <optional>
#include <stdexcept>
#endif

namespace bench {

#ifdef HELIOGRAPH_EMBREE

namespace {

struct Device {
    RTCDevice handle;
    std::atomic<std::int64_t> bytes{0};

    explicit Device(unsigned threads)
        : handle(rtcNewDevice(("threads=" + std::to_string(threads) + ",set_affinity=0").c_str()))
    {
        if (handle == nullptr) throw std::runtime_error("Embree has no device");
        rtcSetDeviceMemoryMonitorFunction(
            handle,
            [](void* self, ssize_t change, bool) {
                static_cast<Device*>(self)->bytes += change;
                return true;
            },
            this);
    }
    ~Device() { rtcReleaseDevice(handle); }
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
};

enum class Quality { standard, robust, high };

class Tree {
public:
    Tree(Device& device,
         const renderer::Mesh& mesh,
         const std::vector<renderer::Vec3f>& positions,
         Quality quality)
    {
        const std::int64_t before = device.bytes;
        scene_ = rtcNewScene(device.handle);
        if (quality == Quality::robust) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        if (quality == Quality::high) rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
        const RTCGeometry geometry = rtcNewGeometry(device.handle, RTC_GEOMETRY_TYPE_TRIANGLE);
        // The geometry's own quality does not follow the scene's.
        if (quality == Quality::high) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
        rtcSetSharedGeometryBuffer(geometry,
                                   RTC_BUFFER_TYPE_VERTEX,
                                   0,
                                   RTC_FORMAT_FLOAT3,
                                   positions.data(),
                                   0,
                                   sizeof(renderer::Vec3f),
                                   mesh.positions.size());
        rtcSetSharedGeometryBuffer(geometry,
                                   RTC_BUFFER_TYPE_INDEX,
                                   0,
                                   RTC_FORMAT_UINT3,
                                   mesh.triangles.data(),
                                   0,
                                   sizeof(renderer::Triangle),
                                   mesh.triangles.size());
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
        bytes_ = static_cast<std::uint64_t>(device.bytes - before);
    }
    ~Tree() { rtcReleaseScene(scene_); }
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;

    RTCScene scene() const { return scene_; }
    std::uint64_t bytes() const { return bytes_; }

private:
    RTCScene scene_ = nullptr;
    std::uint64_t bytes_ = 0;
};

// What all modes share: the mesh, the device for tracing, and one tree a quality.
class Trees {
public:
    explicit Trees(const renderer::Mesh& mesh)
        : mesh_(mesh), positions_(mesh.positions.begin(), mesh.positions.end())
    {
        positions_.emplace_back(); // Embree reads 16 bytes a vertex
    }

    const Tree& of(Quality quality)
    {
        // Not before it is needed: a build that is timed must not find a device alive.
        if (!device_) device_.emplace(renderer::usable_cores());
        std::optional<Tree>& tree = trees_[static_cast<std::size_t>(quality)];
        if (!tree) tree.emplace(*device_, mesh_, positions_, quality);
        return *tree;
    }
    RayEngine::BuildCost time_build(Quality quality, unsigned threads) const
    {
        const std::vector<double> spent = in_fresh_process([&] {
            Device device(threads);
            const Stopwatch watch(CLOCK_PROCESS_CPUTIME_ID);
            const Tree tree(device, mesh_, positions_, quality);
            const Spent s = watch.spent();
            return std::vector<double>{s.wall_s, s.cpu_s};
        });
        return {spent.at(0), spent.at(1)};
    }
    std::uint64_t vertex_bytes() const
    {
        return mesh_.positions.size() * sizeof(renderer::Vec3f) +
               mesh_.triangles.size() * sizeof(renderer::Triangle);
    }

private:
    const renderer::Mesh& mesh_;
    std::vector<renderer::Vec3f> positions_;
    std::optional<Device> device_;
    std::optional<Tree> trees_[3];
};

class EmbreeEngine : public RayEngine {
public:
    EmbreeEngine(std::shared_ptr<Trees> trees, Quality quality, bool packets)
        : trees_(std::move(trees)), quality_(quality), packets_(packets)
    {
    }

    std::string name() const override { return tree() + (packets_ ? ", packets of 16" : ", single rays"); }
    std::string tree() const override
    {
        switch (quality_) {
        case Quality::standard:
            return "Embree";
        case Quality::robust:
            return "Embree robust";
        case Quality::high:
            return "Embree high quality";
        }
        return {};
    }
    bool high_quality() const override { return quality_ == Quality::high; }
    BuildCost time_build(unsigned threads) const override { return trees_->time_build(quality_, threads); }
    void build() override { tree_ = &trees_->of(quality_); }
    std::uint64_t bytes() const override { return tree_->bytes(); }
    std::uint64_t vertex_bytes() const override { return trees_->vertex_bytes(); }

    std::uint64_t trace(const RaySet& set, std::span<const FloatRay> rays, FoundHit* found) const override
    {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags =
            set.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        return packets_ ? trace_packets(set, rays, context, found) : trace_singly(set, rays, context, found);
    }

private:
    std::uint64_t trace_singly(const RaySet& set,
                               std::span<const FloatRay> rays,
                               RTCIntersectContext& context,
                               FoundHit* found) const
    {
        std::uint64_t hits = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const FloatRay& r = rays[i];
            RTCRayHit query{};
            query.ray = {r.origin.x,
                         r.origin.y,
                         r.origin.z,
                         r.t_min,
                         r.direction.x,
                         r.direction.y,
                         r.direction.z,
                         0,
                         r.t_max,
                         0xffffffffu,
                         0,
                         0};
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            bool hit = false;
            if (set.occlusion) {
                rtcOccluded1(tree_->scene(), &context, &query.ray);
                hit = query.ray.tfar < 0;
            } else {
                rtcIntersect1(tree_->scene(), &context, &query);
                hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
            }
            hits += hit;
            if (found != nullptr && hit)
                found[i] = set.occlusion ? FoundHit{0, 0} : FoundHit{query.hit.primID, query.ray.tfar};
        }
        return hits;
    }

    std::uint64_t trace_packets(const RaySet& set,
                                std::span<const FloatRay> rays,
                                RTCIntersectContext& context,
                                FoundHit* found) const
    {
        std::uint64_t hits = 0;
        for (std::size_t first = 0; first < rays.size(); first += 16) {
            const std::size_t count = std::min<std::size_t>(16, rays.size() - first);
            alignas(64) RTCRayHit16 q;
            alignas(64) int valid[16];
            for (std::size_t i = 0; i < 16; ++i) {
                const FloatRay& r = rays[first + std::min(i, count - 1)];
                valid[i] = i < count ? -1 : 0;
                q.ray.org_x[i] = r.origin.x;
                q.ray.org_y[i] = r.origin.y;
                q.ray.org_z[i] = r.origin.z;
                q.ray.tnear[i] = r.t_min;
                q.ray.dir_x[i] = r.direction.x;
                q.ray.dir_y[i] = r.direction.y;
                q.ray.dir_z[i] = r.direction.z;
                q.ray.time[i] = 0;
                q.ray.tfar[i] = r.t_max;
                q.ray.mask[i] = 0xffffffffu;
                q.ray.id[i] = 0;
                q.ray.flags[i] = 0;
                q.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
                q.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
            }
            if (set.occlusion)
                rtcOccluded16(valid, tree_->scene(), &context, &q.ray);
            else
                rtcIntersect16(valid, tree_->scene(), &context, &q);
            for (std::size_t i = 0; i < count; ++i) {
                const bool hit =
                    set.occlusion ? q.ray.tfar[i] < 0 : q.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
                hits += hit ? 1u : 0u;
                if (found != nullptr && hit)
                    found[first + i] =
                        set.occlusion ? FoundHit{0, 0} : FoundHit{q.hit.primID[i], q.ray.tfar[i]};
            }
        }
        return hits;
    }

    std::shared_ptr<Trees> trees_;
    Quality quality_;
    bool packets_;
    const Tree* tree_ = nullptr;
};

} // namespace

std::vector<std::unique_ptr<RayEngine>> make_embree_engines(const renderer::Mesh& mesh)
{
    const auto trees = std::make_shared<Trees>(mesh);
    std::vector<std::unique_ptr<RayEngine>> engines;
    const auto add = [&](Quality quality, bool packets) {
        engines.push_back(std::make_unique<EmbreeEngine>(trees, quality, packets));
    };
    add(Quality::standard, false);
    add(Quality::standard, true);
    add(Quality::robust, false);
    add(Quality::high, false);
    add(Quality::high, true);
    return engines;
}

#else

std::vector<std::unique_ptr<RayEngine>> make_embree_engines(const renderer::Mesh&)
{
    return {};
}

#endif

} // namespace bench
