#include "tests/bench/ray_engine.h"

#ifdef HELIOGRAPH_EMBREE
#include <atomic>
#include <embree3/rtcore.h>
#include <limits>
#include <stdexcept>
#endif

namespace bench {

#ifdef HELIOGRAPH_EMBREE

namespace {

enum class Mode { single, packet, robust, high };

// One device for all modes: a second live one would lend its threads to builds.
struct Device {
    RTCDevice handle = rtcNewDevice("threads=1,set_affinity=0");
    std::atomic<std::int64_t> bytes{0};

    Device()
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

class EmbreeEngine : public RayEngine {
public:
    EmbreeEngine(std::shared_ptr<Device> device, const renderer::Mesh& mesh, Mode mode)
        : device_(std::move(device)), mesh_(mesh), mode_(mode), positions_(mesh.positions)
    {
        positions_.emplace_back(); // Embree reads 16 bytes a vertex
    }
    ~EmbreeEngine() override
    {
        if (scene_ != nullptr) rtcReleaseScene(scene_);
    }
    EmbreeEngine(const EmbreeEngine&) = delete;
    EmbreeEngine& operator=(const EmbreeEngine&) = delete;

    std::string name() const override
    {
        switch (mode_) {
        case Mode::single:
            return "Embree, single ray";
        case Mode::packet:
            return "Embree, packets of 16";
        case Mode::robust:
            return "Embree robust, single";
        case Mode::high:
            return "Embree high quality, single";
        }
        return {};
    }

    void build() override
    {
        if (scene_ != nullptr) rtcReleaseScene(scene_);
        const std::int64_t before = device_->bytes;
        scene_ = rtcNewScene(device_->handle);
        if (mode_ == Mode::robust) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        if (mode_ == Mode::high) rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
        const RTCGeometry geometry = rtcNewGeometry(device_->handle, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry,
                                   RTC_BUFFER_TYPE_VERTEX,
                                   0,
                                   RTC_FORMAT_FLOAT3,
                                   positions_.data(),
                                   0,
                                   sizeof(renderer::Vec3f),
                                   mesh_.positions.size());
        rtcSetSharedGeometryBuffer(geometry,
                                   RTC_BUFFER_TYPE_INDEX,
                                   0,
                                   RTC_FORMAT_UINT3,
                                   mesh_.triangles.data(),
                                   0,
                                   sizeof(renderer::Triangle),
                                   mesh_.triangles.size());
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
        bytes_ = static_cast<std::uint64_t>(device_->bytes - before);
    }
    std::uint64_t bytes() const override { return bytes_; }
    std::uint64_t vertex_bytes() const override
    {
        return mesh_.positions.size() * sizeof(renderer::Vec3f) +
               mesh_.triangles.size() * sizeof(renderer::Triangle);
    }

    std::uint64_t trace(const RaySet& set, std::span<const FloatRay> rays) const override
    {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags =
            set.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        return mode_ == Mode::packet ? trace_packets(set, rays, context) : trace_singly(set, rays, context);
    }

private:
    std::uint64_t
    trace_singly(const RaySet& set, std::span<const FloatRay> rays, RTCIntersectContext& context) const
    {
        std::uint64_t hits = 0;
        for (const FloatRay& r : rays) {
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
            if (set.occlusion) {
                rtcOccluded1(scene_, &context, &query.ray);
                hits += query.ray.tfar < 0;
            } else {
                rtcIntersect1(scene_, &context, &query);
                hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
            }
        }
        return hits;
    }

    std::uint64_t
    trace_packets(const RaySet& set, std::span<const FloatRay> rays, RTCIntersectContext& context) const
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
                rtcOccluded16(valid, scene_, &context, &q.ray);
            else
                rtcIntersect16(valid, scene_, &context, &q);
            for (std::size_t i = 0; i < count; ++i)
                hits += (set.occlusion ? q.ray.tfar[i] < 0 : q.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) ? 1u
                                                                                                         : 0u;
        }
        return hits;
    }

    std::shared_ptr<Device> device_;
    const renderer::Mesh& mesh_;
    Mode mode_;
    std::vector<renderer::Vec3f> positions_;
    RTCScene scene_ = nullptr;
    std::uint64_t bytes_ = 0;
};

} // namespace

std::vector<std::unique_ptr<RayEngine>> make_embree_engines(const renderer::Mesh& mesh)
{
    const auto device = std::make_shared<Device>();
    std::vector<std::unique_ptr<RayEngine>> engines;
    for (const Mode mode : {Mode::single, Mode::packet, Mode::robust, Mode::high})
        engines.push_back(std::make_unique<EmbreeEngine>(device, mesh, mode));
    return engines;
}

#else

std::vector<std::unique_ptr<RayEngine>> make_embree_engines(const renderer::Mesh&)
{
    return {};
}

#endif

} // namespace bench
