// What a layer of ozone absorbs.
#pragma once

namespace renderer {

// 1/m at the peak of a tent that holds 300 Dobson units over 15 km of half width; linear between tabulated wavelengths,
// 10 nm apart from 360 to 830 nm, and that of the nearest beyond them.
double ozone_absorption(double wavelength_nm);

} // namespace renderer
