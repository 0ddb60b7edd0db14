#include "renderer/description/check_atmosphere.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace renderer {

namespace {

class Check {
public:
    Check(const std::string& pointer, std::vector<Fault>& faults) : pointer_(pointer), faults_(faults) {}

    void need(bool right, const char* member, const char* code, std::string detail)
    {
        if (!right) faults_.push_back({pointer_ + member, code, std::move(detail)});
    }
    // Empty, one for all, or one a wavelength; none negative.
    void list(const std::vector<double>& values, std::size_t wavelengths, const char* member, double most)
    {
        need(values.size() <= 1 || values.size() == wavelengths,
             member,
             "wrong_length",
             "there are " + std::to_string(wavelengths) + " wavelengths: give one number, or one for each");
        const bool in_range =
            std::all_of(values.begin(), values.end(), [most](double x) { return x >= 0 && x <= most; });
        need(in_range,
             member,
             "out_of_range",
             "a coefficient is 0 or more" + std::string(most <= 1 ? ", and 1 at most" : ""));
    }

private:
    const std::string& pointer_;
    std::vector<Fault>& faults_;
};

bool positive(double x)
{
    return x > 0 && std::isfinite(x);
}

bool all_differ(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return std::adjacent_find(values.begin(), values.end()) == values.end();
}

} // namespace

std::vector<Fault> check_atmosphere(const AtmosphereDescription& a, const std::string& pointer)
{
    std::vector<Fault> faults;
    Check check(pointer, faults);
    const std::size_t n = a.wavelengths_nm.size();
    check.need(n > 0 && n <= kMostWavelengths &&
                   std::all_of(a.wavelengths_nm.begin(), a.wavelengths_nm.end(), positive),
               "/wavelengths_nm",
               "out_of_range",
               "give 1 to " + std::to_string(kMostWavelengths) + " wavelengths above 0");
    check.need(all_differ(a.wavelengths_nm),
               "/wavelengths_nm",
               "conflict",
               "a wavelength is named once: coefficients and colours are one for each");
    check.need(
        positive(a.planet.radius_m), "/planet/radius_m", "out_of_range", "a planet's radius is above 0");
    check.need(std::isfinite(a.planet.top_m) && a.planet.top_m > a.planet.radius_m,
               "/planet/top_m",
               "out_of_range",
               "the top of the air is not above the ground: top_m is measured from the planet's centre, as "
               "radius_m");
    check.list(a.planet.ground_albedo, n, "/planet/ground_albedo", 1);
    check.list(a.rayleigh.scattering, n, "/rayleigh/scattering", 1e30);
    check.need(positive(a.rayleigh.scale_height_m),
               "/rayleigh/scale_height_m",
               "out_of_range",
               "a scale height is above 0");
    check.list(a.mie.scattering, n, "/mie/scattering", 1e30);
    check.list(a.mie.extinction, n, "/mie/extinction", 1e30);
    check.need(
        positive(a.mie.scale_height_m), "/mie/scale_height_m", "out_of_range", "a scale height is above 0");
    check.need(std::abs(a.mie.g) < 1, "/mie/g", "out_of_range", "g lies between -1 and 1, neither included");
    for (std::size_t i = 0; i < std::min(a.mie.scattering.size(), a.mie.extinction.size()); ++i)
        if (a.mie.scattering[i] > a.mie.extinction[i]) {
            check.need(false,
                       "/mie/extinction",
                       "conflict",
                       "extinction holds scattering and absorption: it is not less than scattering");
            break;
        }
    check.list(a.ozone.absorption, n, "/ozone/absorption", 1e30);
    check.need(std::isfinite(a.ozone.center_m), "/ozone/center_m", "out_of_range", "an altitude");
    check.need(positive(a.ozone.half_width_m), "/ozone/half_width_m", "out_of_range", "a width is above 0");
    check.need(std::isfinite(a.sun.elevation_deg), "/sun/elevation_deg", "out_of_range", "an angle");
    check.need(std::isfinite(a.sun.azimuth_deg), "/sun/azimuth_deg", "out_of_range", "an angle");
    check.need(a.altitude_m >= 0 && std::isfinite(a.altitude_m),
               "/altitude_m",
               "out_of_range",
               "the world's origin lies on the ground or above it");
    return faults;
}

} // namespace renderer
