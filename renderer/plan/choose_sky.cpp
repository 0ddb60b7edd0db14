#include "renderer/plan/choose_sky.h"

#include "renderer/color/strongest.h"
#include "renderer/math/transcendental.h"
#include "renderer/plan/light_shapes.h"
#include "renderer/plan/number_in_words.h"
#include "renderer/plan/world_bounds.h"
#include "renderer/sky/air.h"
#include "renderer/sky/color_error.h"
#include "renderer/sky/sky_light.h"
#include "renderer/sky/standing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <variant>

namespace renderer {

namespace {

// Of a picture's light, that air before things may be left out for.
constexpr double kMostLeftOut = 0.01;

const AtmosphereDescription* atmosphere_of(const SceneDescription& scene)
{
    return scene.environment ? std::get_if<AtmosphereDescription>(&*scene.environment) : nullptr;
}

// How far things are seen, and how low air lies before them.
struct Depth {
    double far_m = 0, lowest_m = 0;
};

Depth depth_of(const SceneDescription& scene, std::span<const MeshFacts> meshes)
{
    const Vec3d eye = scene.camera->position;
    Depth depth{0, eye.y};
    const auto look_at = [&](const ObjectDescription& object) {
        if (object_bounds(object.shape, meshes).empty()) return;
        for (const Vec3d& corner : world_corners(object, meshes)) {
            depth.far_m = std::max(depth.far_m, length(corner - eye));
            depth.lowest_m = std::min(depth.lowest_m, corner.y);
        }
    };
    for (const ObjectDescription& object : scene.objects)
        look_at(object);
    for (const Light& light : scene.lights)
        if (const std::optional<LightShape> shaped = shape_of(light)) look_at(shaped->object);
    return depth;
}

bool is_mirror_or_pane(const Material& material)
{
    const auto is_smooth = [](const TexturedNumber& roughness) {
        return !roughness.texture && roughness.value == 0;
    };
    if (const auto* const glass = std::get_if<GlassMaterial>(&material)) return is_smooth(glass->roughness);
    if (const auto* const metal = std::get_if<ConductorMaterial>(&material))
        return is_smooth(metal->roughness);
    if (const auto* const varnish = std::get_if<CookTorranceMaterial>(&material))
        return is_smooth(varnish->roughness);
    return std::holds_alternative<MirrorMaterial>(material);
}

// The share of what the air does by which it is off behind mirrors and panes, where rays are taken as if they came from the
// eye: by the height between them, and the turn of the vertical. Negative: there are no such things.
double
most_off_behind_mirrors(const SceneDescription& scene, std::span<const MeshFacts> meshes, const Air& air)
{
    const auto scatters = [](double x) { return x > 0; };
    double scale_height = std::numeric_limits<double>::infinity();
    if (std::any_of(air.rayleigh.begin(), air.rayleigh.end(), scatters)) scale_height = air.rayleigh_height_m;
    if (std::any_of(air.mie_extinction.begin(), air.mie_extinction.end(), scatters))
        scale_height = std::min(scale_height, air.mie_height_m);
    const Vec3d eye = scene.camera->position;
    double most = -1;
    for (const ObjectDescription& object : scene.objects) {
        if (!object.material || !is_mirror_or_pane(scene.materials[*object.material].material)) continue;
        if (object_bounds(object.shape, meshes).empty()) continue;
        for (const Vec3d& corner : world_corners(object, meshes)) {
            const double up = (corner.y - eye.y) / scale_height, turn = length(corner - eye) / air.radius_m;
            most = std::max(most, (up > 0 ? exp(std::min(up, 700.0)) - 1 : 1 - exp(up)) + turn);
        }
    }
    return most;
}

// Extinction per metre at the wavelength nearest to 550 nm, at most, from an altitude upwards.
double most_extinction(const Air& air, double altitude)
{
    const auto nearest =
        std::min_element(air.wavelength_nm.begin(), air.wavelength_nm.end(), [](double a, double b) {
            return std::abs(a - 550) < std::abs(b - 550);
        });
    Columns density = air.density(std::max(0.0, altitude));
    density.ozone = 1; // its peak may lie above
    return air.optical_depth(static_cast<std::size_t>(nearest - air.wavelength_nm.begin()), density);
}

// What the choice of wavelengths costs.
std::string colors_in_words(const AtmosphereDescription& a, double altitude, double mu_sun)
{
    constexpr double kMuchOff = 0.1;
    constexpr std::size_t kDozen = 12;
    const std::size_t n = a.wavelengths_nm.size();
    const std::string how = n == 3
                                ? "three stand for red, green and blue as they are"
                                : std::to_string(n) + (n == 1 ? ": all light is of one colour"
                                                              : " are weighted by the eye's colour matching");
    const std::optional<ColorError> error = color_error(a, altitude, mu_sun);
    if (!error)
        return how + "; how far off their colours are cannot be told: the coefficients are listed one by "
                     "one, or no air is lit";
    return how + "; against " + std::to_string(kDenseWavelengths) + " of them the sky's colours are " +
           number_in_words(100 * error->sky) + " % off and the sun's " + number_in_words(100 * error->sun) +
           " % (rms, light scattered once)" +
           (std::max(error->sky, error->sun) > kMuchOff && n < kDozen ? "; more of them come nearer" : "");
}

} // namespace

std::optional<SkyPlan> choose_sky(const SceneDescription& scene,
                                  std::span<const MeshFacts> meshes,
                                  Integrator integrator,
                                  ModelReport& models)
{
    const AtmosphereDescription* const a = atmosphere_of(scene);
    if (a == nullptr || !is_lit(integrator)) return std::nullopt;
    constexpr double kExactTableError = 0.001;
    SkyPlan plan;
    plan.table_error = a->mode == SkyMode::exact ? kExactTableError : SkyLight::kTableError;
    plan.mode = a->mode == SkyMode::automatic ? SkyMode::fast : a->mode;
    models.used.push_back(
        {"atmosphere",
         "sky and sun by the air's scattering, from a table that is refined until it is " +
             number_in_words(100 * plan.table_error) +
             " % from quadrature, twice at most, and whose error the report tells; " +
             (a->mode == SkyMode::automatic ? "`mode` auto: the quick tables are exact enough for pictures"
              : a->mode == SkyMode::fast    ? "`mode` asks for the quick tables"
                                            : "`mode` asks for the exact ones")});
    if (a->scattering == SkyScattering::multiple)
        models.used.push_back(
            {"multiple_scattering", "light that the air and the ground scatter again, every order"});
    else
        models.skipped.push_back({"multiple_scattering",
                                  "`scattering` asks for single: 7 % (red) to 38 % (blue) "
                                  "of a clear sky's irradiance, nearly all of twilight"});

    const Standing eye(a->planet.radius_m, a->altitude_m, scene.camera->position);
    if (eye.above_ground < 0)
        models.used.push_back({"sky_from_the_ground",
                               "warning: the camera lies " + number_in_words(-eye.above_ground) +
                                   " m below the planet's ground: it sees the sky of the ground above it"});

    models.used.push_back(
        {"wavelengths", colors_in_words(*a, eye.altitude(), dot(eye.up, direction_of_sun(a->sun)))});

    const Depth depth = depth_of(scene, meshes);
    const Air air = make_air(*a);
    const double bound = 1 - exp(-most_extinction(air, a->altitude_m + depth.lowest_m) * depth.far_m);
    const std::string seen = number_in_words(depth.far_m) + " m away at most: the air before it takes " +
                             number_in_words(100 * bound) + " % at 550 nm at most";
    if (!a->aerial_perspective)
        models.skipped.push_back({"aerial_perspective", "the scene asks for none; things are " + seen});
    else if (!(bound >= kMostLeftOut))
        models.skipped.push_back(
            {"aerial_perspective", "bound " + number_in_words(bound) + ": things are " + seen});
    else {
        plan.far_m = depth.far_m;
        const double off = most_off_behind_mirrors(scene, meshes, air);
        models.used.push_back(
            {"aerial_perspective",
             "things are " + seen + "; between camera and things, not between things" +
                 (off < 0 ? std::string()
                          : "; behind mirrors and panes as if seen from the camera, off by " +
                                number_in_words(100 * off) + " % of its effect at most")});
    }
    return plan;
}

double choose_exposure(const ImageSettings& image,
                       const SceneDescription& scene,
                       Integrator integrator,
                       ModelReport& models)
{
    if (image.exposure_ev) return *image.exposure_ev;
    const AtmosphereDescription* const a = atmosphere_of(scene);
    if (a == nullptr || !is_lit(integrator) || !(strongest(a->sun.irradiance) > 0)) return 0;
    // Day, sunset, twilight, night: about what keeps white things and the sky near the sun within a picture's range.
    struct Stop {
        double elevation_deg, ev;
    };
    constexpr std::array kStops{
        Stop{-18, 10}, Stop{-10, 8}, Stop{-4, 5.5}, Stop{2, 3}, Stop{10, 1.8}, Stop{30, 1}};
    double ev = kStops.back().ev;
    if (a->sun.elevation_deg <= kStops.front().elevation_deg) ev = kStops.front().ev;
    for (std::size_t i = 0; i + 1 < kStops.size(); ++i) {
        const Stop &low = kStops[i], &high = kStops[i + 1];
        if (a->sun.elevation_deg <= low.elevation_deg || a->sun.elevation_deg > high.elevation_deg) continue;
        const double share =
            (a->sun.elevation_deg - low.elevation_deg) / (high.elevation_deg - low.elevation_deg);
        ev = low.ev + (high.ev - low.ev) * share;
    }
    // Beyond the air the sun stands in full light whatever its elevation.
    const Air air = make_air(*a);
    if (a->altitude_m + scene.camera->position.y > air.height_m) ev = kStops.back().ev;
    constexpr double kUsualIrradiance = 1.5;
    ev += log2(kUsualIrradiance / static_cast<double>(strongest(a->sun.irradiance)));
    models.used.push_back({"assumed_exposure",
                           "no `exposure_ev` is given: " + number_in_words(ev) +
                               " EV, for the sun's elevation and irradiance"});
    return ev;
}

} // namespace renderer
