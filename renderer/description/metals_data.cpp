// P. Johnson, R. Christy, "Optical constants of the noble metals", Phys. Rev. B 6, 1972: copper, gold,
// silver; of the same, "Optical constants of transition metals", Phys. Rev. B 9, 1974: chromium, iron,
// nickel, titanium; A. Rakic, Appl. Opt. 34, 1995: aluminium; A. Rakic et al., Appl. Opt. 37, 1998, their
// Brendel-Bormann model: platinum; J. Weaver et al., Phys. Rev. B 12, 1975: tungsten.
#include "renderer/description/metals.h"

namespace renderer {

ComplexIor complex_ior(Metal metal)
{
    switch (metal) {
    case Metal::aluminium:
        return {{1.320f, 1.011f, 0.683f}, {7.307f, 6.616f, 5.623f}};
    case Metal::chromium:
        return {{3.179f, 3.180f, 2.447f}, {3.300f, 3.330f, 3.205f}};
    case Metal::copper:
        return {{0.367f, 1.016f, 1.246f}, {3.121f, 2.579f, 2.452f}};
    case Metal::gold:
        return {{0.223f, 0.428f, 1.335f}, {3.204f, 2.460f, 1.872f}};
    case Metal::iron:
        return {{2.890f, 2.950f, 2.642f}, {3.040f, 2.930f, 2.803f}};
    case Metal::nickel:
        return {{1.985f, 1.920f, 1.763f}, {3.982f, 3.610f, 3.041f}};
    case Metal::platinum:
        return {{2.256f, 2.082f, 1.877f}, {4.058f, 3.710f, 3.217f}};
    case Metal::silver:
        return {{0.058f, 0.060f, 0.046f}, {4.103f, 3.589f, 2.792f}};
    case Metal::titanium:
        return {{2.658f, 2.540f, 2.303f}, {3.696f, 3.430f, 3.079f}};
    case Metal::tungsten:
        return {{3.578f, 3.522f, 3.324f}, {2.881f, 2.739f, 2.570f}};
    }
    return {};
}

} // namespace renderer
