#include "renderer/sky/air.h"

#include "renderer/sky/ozone_data.h"

#include <algorithm>

namespace renderer {

namespace {

// Per metre, at the wavelengths of `nm`, of the preset's own constituents.
struct Laws {
    double rayleigh_um4 = 1.24062e-6; // times lambda^-4, lambda in um
    double mie_extinction = 5.328e-3 / 1200;
    double mie_albedo_443 = 0.9, mie_albedo_671 = 0.9; // linear in between, constant beyond
    double ozone = 1;                                  // of the earth's 300 DU
    double ground_443 = 0, ground_671 = 0;             // linear in between, constant beyond
};

Laws laws_of(AtmospherePreset preset)
{
    switch (preset) {
    case AtmospherePreset::earth:
    case AtmospherePreset::reference_b:
        return {.ground_443 = 0.1, .ground_671 = 0.1};
    case AtmospherePreset::reference_r:
        return {.mie_extinction = 0, .ozone = 0};
    case AtmospherePreset::reference_s:
        return {.mie_extinction = 21e-6 / 0.9, .ozone = 0};
    case AtmospherePreset::mars:
        // CO2 of 610 Pa at 210 K, 2.104e23 molecules/m^3 of 1.24e-30 m^2 at 532.2 nm (Sneep, Ubachs 2005). Dust of
        // optical depth 0.5 (Lemmon et al. 2015, clear season) over a scale height of 11.1 km, its albedo after
        // Tomasko et al. 1999: 0.75 at 443 nm, 0.94 at 671 nm. Ground of the plains: a twelfth of blue, a quarter of
        // red.
        return {.rayleigh_um4 = 2.104e23 * 1.24e-30 * 0.080225,
                .mie_extinction = 0.5 / 11'100,
                .mie_albedo_443 = 0.75,
                .mie_albedo_671 = 0.94,
                .ozone = 0,
                .ground_443 = 0.08,
                .ground_671 = 0.25};
    }
    return {};
}

double between(double nm, double at_443, double at_671)
{
    return at_443 + (at_671 - at_443) * std::clamp((nm - 443) / (671 - 443), 0.0, 1.0);
}

// The one value there is, or that of each wavelength.
double entry(const std::vector<double>& list, std::size_t i)
{
    return list.size() == 1 ? list[0] : list[i];
}

void add_cuts(Air& air)
{
    std::vector<double> cuts{air.ozone_center_m - air.ozone_half_width_m,
                             air.ozone_center_m,
                             air.ozone_center_m + air.ozone_half_width_m};
    if (std::all_of(air.ozone.begin(), air.ozone.end(), [](double a) { return a == 0; })) cuts.clear();
    for (const double height : {air.rayleigh_height_m, air.mie_height_m})
        for (const double falls : {6.0, 18.0, 42.0})
            cuts.push_back(falls * height);
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    std::erase_if(cuts, [&](double cut) { return cut <= 0 || cut >= air.height_m; });
    air.cuts = std::move(cuts);
}

} // namespace

Air make_air(const AtmosphereDescription& description)
{
    const Laws laws = laws_of(description.preset);
    Air air;
    air.radius_m = description.planet.radius_m;
    air.height_m = description.planet.top_m - description.planet.radius_m;
    air.rayleigh_height_m = description.rayleigh.scale_height_m;
    air.mie_height_m = description.mie.scale_height_m;
    air.ozone_center_m = description.ozone.center_m;
    air.ozone_half_width_m = description.ozone.half_width_m;
    air.g = description.mie.g;
    air.phase = description.mie.phase;
    air.wavelengths = description.wavelengths_nm.size();
    air.wavelength_nm = description.wavelengths_nm;
    for (std::size_t i = 0; i < air.wavelengths; ++i) {
        const double nm = air.wavelength_nm[i], um2 = nm * nm * 1e-6;
        const auto or_law = [i](const std::vector<double>& list, double law) {
            return list.empty() ? law : entry(list, i);
        };
        const double albedo = between(nm, laws.mie_albedo_443, laws.mie_albedo_671);
        const bool scattering_alone =
            description.mie.extinction.empty() && !description.mie.scattering.empty();
        air.rayleigh.push_back(or_law(description.rayleigh.scattering, laws.rayleigh_um4 / (um2 * um2)));
        air.mie_extinction.push_back(scattering_alone
                                         ? entry(description.mie.scattering, i) / albedo
                                         : or_law(description.mie.extinction, laws.mie_extinction));
        air.mie_scattering.push_back(or_law(description.mie.scattering, albedo * air.mie_extinction.back()));
        air.ozone.push_back(or_law(description.ozone.absorption, laws.ozone * ozone_absorption(nm)));
        air.ground_albedo.push_back(
            or_law(description.planet.ground_albedo, between(nm, laws.ground_443, laws.ground_671)));
    }
    add_cuts(air);
    return air;
}

} // namespace renderer
