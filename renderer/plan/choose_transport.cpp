#include "renderer/plan/choose_transport.h"

#include "renderer/plan/light_shapes.h"

#include <limits>
#include <string>
#include <utility>
#include <variant>

namespace renderer {

namespace {

// So many lights that have a place are asked one by one at every point; of more, one is picked.
constexpr std::uint64_t kMostAsked = 4;

// What decides: counted in objects, but for lights.
struct Kinds {
    std::size_t physical = 0, empirical = 0; // the rest: mirrors and smooth glass
    std::size_t glass = 0;                   // smooth or rough
    std::size_t sharp = 0;                   // may send light a single way: no light can be asked for it
    std::size_t shapes = 0;                  // all objects
    std::size_t not_convex = 0;              // that may light themselves
    std::uint64_t emitters = 0;              // pieces of surfaces that shine
    std::uint64_t placed = 0;                // point and spot lights
    std::size_t extended = 0;                // suns
    bool sky = false, sky_varies = false;
};

class Counter {
public:
    Counter(const SceneDescription& scene, std::span<const MeshFacts> meshes) : scene_(scene), meshes_(meshes)
    {
    }

    Kinds run()
    {
        for (const ObjectDescription& object : scene_.objects)
            count(object);
        for (const Light& light : scene_.lights)
            count(light);
        if (scene_.environment) {
            kinds_.sky = !std::holds_alternative<NoEnvironment>(*scene_.environment);
            kinds_.sky_varies = kinds_.sky && !std::holds_alternative<ColorEnvironment>(*scene_.environment);
        }
        return kinds_;
    }

private:
    std::uint64_t pieces(const Shape& shape) const
    {
        if (const auto* const mesh = std::get_if<MeshShape>(&shape)) return meshes_[mesh->mesh].triangles;
        return std::holds_alternative<BoxShape>(shape) ? 12 : 1;
    }

    void count(const ObjectDescription& object)
    {
        ++kinds_.shapes;
        const auto* const mesh = std::get_if<MeshShape>(&object.shape);
        if (mesh != nullptr) ++kinds_.not_convex;
        if (!object.material) {
            if (mesh == nullptr) {
                ++kinds_.physical; // the default
                return;
            }
            const MeshFacts& own = meshes_[mesh->mesh];
            if (!own.is_all_glass || own.rough_glass_materials != 0) ++kinds_.physical;
            if (own.glass_materials != 0) ++kinds_.glass;
            if (own.physical_materials + own.glass_materials != 0) ++kinds_.sharp;
            kinds_.emitters += own.shining_triangles;
            return;
        }
        const Material& material = scene_.materials[*object.material].material;
        if (std::holds_alternative<EmitterMaterial>(material)) {
            kinds_.emitters += pieces(object.shape);
        } else if (std::holds_alternative<PhongMaterial>(material)) {
            ++kinds_.empirical;
        } else if (std::holds_alternative<MirrorMaterial>(material)) {
            ++kinds_.sharp;
        } else if (const auto* const glass = std::get_if<GlassMaterial>(&material)) {
            ++kinds_.glass;
            ++kinds_.sharp;
            if (!is_smooth(glass->roughness) || glass->roughness.texture) ++kinds_.physical;
        } else {
            ++kinds_.physical;
            const TexturedNumber* const roughness = roughness_of(material);
            if (roughness != nullptr && (is_smooth(*roughness) || roughness->texture)) ++kinds_.sharp;
        }
    }

    static bool is_smooth(const TexturedNumber& roughness) { return roughness.value < kSmoothBelow; }

    static const TexturedNumber* roughness_of(const Material& material)
    {
        if (const auto* const metal = std::get_if<ConductorMaterial>(&material)) return &metal->roughness;
        if (const auto* const varnish = std::get_if<CookTorranceMaterial>(&material))
            return &varnish->roughness;
        return nullptr;
    }

    void count(const Light& light)
    {
        if (std::holds_alternative<SunLight>(light))
            ++kinds_.extended;
        else if (std::holds_alternative<PointLight>(light) || std::holds_alternative<SpotLight>(light))
            ++kinds_.placed;
        else if (shape_of(light))
            ++kinds_.emitters;
    }

    const SceneDescription& scene_;
    std::span<const MeshFacts> meshes_;
    Kinds kinds_;
};

class Chooser {
public:
    Chooser(const TransportDescription& asked, const Kinds& kinds) : asked_(asked), k_(kinds) {}

    TransportChoice run()
    {
        switch (asked_.type) {
        case TransportType::automatic:
            automatic();
            break;
        case TransportType::direct:
            direct("the scene asks for it: light is scattered once on its way from lights to the camera");
            break;
        case TransportType::whitted:
            whitted("the scene asks for it");
            break;
        case TransportType::path:
            path("the scene asks for it");
            break;
        case TransportType::ambient_occlusion:
            out_.integrator = Integrator::ambient_occlusion;
            use("ambient_occlusion", "the scene asks for it: how much of the sky each surface sees");
            skip("lights", "ambient occlusion looks at shapes alone");
            break;
        case TransportType::normals:
            out_.integrator = Integrator::normals;
            use("normals", "the scene asks for it: which way surfaces face");
            skip("lights", "normals are shown whatever the light");
            break;
        }
        return std::move(out_);
    }

private:
    void use(std::string name, std::string why) { out_.used.push_back({std::move(name), std::move(why)}); }
    void skip(std::string name, std::string why)
    {
        out_.skipped.push_back({std::move(name), std::move(why)});
    }

    bool lights_have_extent() const { return k_.emitters != 0 || k_.extended != 0 || k_.sky_varies; }
    bool is_sharp() const { return k_.sharp != 0; }
    // Nothing is lit by anything else, nor by itself from within: one convex body, not of glass, or none.
    bool is_alone() const
    {
        return k_.shapes + (k_.emitters != 0 ? 1 : 0) <= 1 && k_.not_convex == 0 && k_.glass == 0;
    }

    void automatic()
    {
        if (k_.physical == 0 && !lights_have_extent()) {
            if (is_sharp())
                return whitted("every material is of the classic models, every light without extent: that is "
                               "Whitted's definition, and has no noise inside surfaces");
            return direct(k_.empirical == 0
                              ? "there is no surface that light could be scattered by twice"
                              : "every material is Phong's, which is defined by direct light alone");
        }
        if (is_alone()) return direct("a single convex surface: nothing else is there that could light it");
        path(k_.physical != 0 ? "surfaces light one another"
                              : "lights have extent, and mirrors and glass show them");
    }

    void direct(std::string why)
    {
        out_.max_depth = asked_.max_depth.value_or(1) == 0 ? 0 : 1;
        const bool is_short = !lights_have_extent() && !is_sharp() && out_.max_depth == 1;
        out_.integrator = is_short ? Integrator::direct : Integrator::path;
        out_.picks_lights = k_.emitters > kMostAsked;
        use("direct", std::move(why));
        if (is_alone())
            skip("indirect_light", "bound 0: nothing is there that could scatter light onto anything else");
        else
            skip("indirect_light", "transport is direct: light that scatters more than once is left out");
    }

    void whitted(std::string why)
    {
        out_.integrator = Integrator::whitted;
        out_.max_depth = asked_.max_depth.value_or(kWhittedDepth);
        out_.picks_lights = k_.emitters > kMostAsked;
        use("whitted",
            std::move(why) + "; mirrors and glass are followed for " + std::to_string(out_.max_depth) +
                " scatterings");
        skip("indirect_light",
             "light from one surface onto another is not followed but by mirrors and glass");
        if (k_.glass != 0) skip("caustics", "light that glass or mirrors gather on a surface is not found");
    }

    void path(std::string why)
    {
        out_.integrator = Integrator::path;
        out_.max_depth = asked_.max_depth.value_or(std::numeric_limits<std::uint32_t>::max());
        out_.picks_lights = k_.emitters + k_.placed > kMostAsked;
        use("path",
            std::move(why) + (asked_.max_depth
                                  ? ": followed for " + std::to_string(*asked_.max_depth) + " scatterings"
                                  : ": followed until chance ends them, without a bound"));
        use("russian_roulette",
            "after three scatterings a path goes on by chance, in proportion to what it carries");
        if (lights_have_extent())
            use("multiple_importance_sampling", "lights are asked and also found by the material's own rays");
        if (is_sharp() && !lights_have_extent())
            skip("caustics",
                 "lights without extent cannot be met by chance: their light through glass or by mirrors "
                 "onto other surfaces is not found");
    }

    const TransportDescription& asked_;
    const Kinds& k_;
    TransportChoice out_;
};

} // namespace

TransportChoice choose_transport(const SceneDescription& scene, std::span<const MeshFacts> meshes)
{
    const Kinds kinds = Counter(scene, meshes).run();
    return Chooser(scene.transport, kinds).run();
}

} // namespace renderer
