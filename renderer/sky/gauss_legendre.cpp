#include "renderer/sky/gauss_legendre.h"

#include "renderer/math/transcendental.h"

namespace renderer {

// Newton's method on the Legendre polynomial, whose recurrence gives value and derivative.
GaussLegendre::GaussLegendre(std::size_t n) : x(n), weight(n)
{
    for (std::size_t i = 0; i < n; ++i) {
        const double count = static_cast<double>(n);
        double z = -sin_cos(kPi * (static_cast<double>(i) + 0.75) / (count + 0.5)).second;
        double slope = 1;
        for (int step = 0; step < 8; ++step) {
            double value = 1, previous = 0;
            for (std::size_t k = 1; k <= n; ++k) {
                const double order = static_cast<double>(k);
                const double next = ((2 * order - 1) * z * value - (order - 1) * previous) / order;
                previous = value;
                value = next;
            }
            slope = count * (z * value - previous) / (z * z - 1);
            z -= value / slope;
        }
        x[i] = (1 + z) / 2;
        weight[i] = 1 / ((1 - z * z) * slope * slope);
    }
}

} // namespace renderer
